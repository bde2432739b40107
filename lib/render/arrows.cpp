// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/arrows.h"

#include <vtkActor.h>
#include <vtkArrowSource.h>
#include <vtkDoubleArray.h>
#include <vtkGlyph3DMapper.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

namespace sinew {
namespace {

vtkNew<vtkPolyData> data_of(const std::vector<ShotArrow>& arrows, const ColourScale& scale) {
  vtkNew<vtkPoints> points;
  vtkNew<vtkDoubleArray> along;
  along->SetName("along");
  along->SetNumberOfComponents(3);
  vtkNew<vtkUnsignedCharArray> colours;
  colours->SetNumberOfComponents(3);
  for (const ShotArrow& arrow : arrows) {
    points->InsertNextPoint(arrow.from.data());
    along->InsertNextTuple(arrow.along.data());
    colours->InsertNextTypedTuple(scale.colour(arrow.value).data());
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->GetPointData()->AddArray(along);
  data->GetPointData()->SetScalars(colours);
  return data;
}

}  // namespace

void add_arrows(vtkRenderer& renderer, const Shot& shot, const ColourScale& scale) {
  if (shot.arrows.empty()) return;
  vtkNew<vtkArrowSource> shape;
  shape->SetTipRadius(0.11);
  shape->SetShaftRadius(0.04);
  shape->SetTipResolution(16);
  shape->SetShaftResolution(12);
  vtkNew<vtkGlyph3DMapper> mapper;
  mapper->SetInputData(data_of(shot.arrows, scale));
  mapper->SetSourceConnection(shape->GetOutputPort());
  mapper->SetOrientationArray("along");
  mapper->SetScaleArray("along");
  mapper->SetScaleModeToScaleByMagnitude();
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetAmbient(0.3);
  actor->GetProperty()->SetDiffuse(0.75);
  renderer.AddActor(actor);
}

}  // namespace sinew

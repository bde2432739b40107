// SPDX-License-Identifier: GPL-3.0-or-later
// What is drawn of lines: arrows, bonds, paths, traces.
#include <sinew/render/detail/actors.h>

#include <vtkActor.h>
#include <vtkArrowSource.h>
#include <vtkGlyph3DMapper.h>
#include <vtkPointData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkTubeFilter.h>
#include <vtkUnsignedCharArray.h>

#include <sinew/render/detail/shapes.h>

namespace sinew {

namespace {

template <class Arrow, class ColorOf>
vtkNew<vtkPolyData> data_of(const std::vector<Arrow>& arrows, const ColorOf& color_of) {
  vtkNew<vtkPoints> points;
  vtkNew<vtkDoubleArray> along;
  along->SetName("along");
  along->SetNumberOfComponents(3);
  vtkNew<vtkUnsignedCharArray> colors;
  colors->SetNumberOfComponents(3);
  for (const Arrow& arrow : arrows) {
    points->InsertNextPoint(arrow.from.data());
    along->InsertNextTuple(arrow.along.data());
    colors->InsertNextTypedTuple(color_of(arrow).data());
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->GetPointData()->AddArray(along);
  data->GetPointData()->SetScalars(colors);
  return data;
}

void add_glyphs(vtkRenderer& renderer, vtkPolyData* arrows) {
  vtkNew<vtkArrowSource> shape;
  shape->SetTipRadius(0.11);
  shape->SetShaftRadius(0.04);
  shape->SetTipResolution(16);
  shape->SetShaftResolution(12);
  vtkNew<vtkGlyph3DMapper> mapper;
  mapper->SetInputData(arrows);
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

}  // namespace

void add_arrows(vtkRenderer& renderer, const Snapshot& snapshot, const ColorScale& scale) {
  if (snapshot.arrows.empty()) return;
  const auto color = [&](const SnapshotArrow& arrow) { return scale.color(arrow.value); };
  add_glyphs(renderer, data_of(snapshot.arrows, color));
}

void add_forces(vtkRenderer& renderer, const Snapshot& snapshot, const Paper& paper) {
  const auto color = [&](const SnapshotForce& force) {
    return readable_on(paper.background, force.is_load ? palette::loaded : palette::held);
  };
  add_glyphs(renderer, data_of(snapshot.forces, color));
}

namespace {

vtkNew<vtkPolyData> data_of(const std::vector<SnapshotLine>& lines, const ColorScale& scale) {
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkUnsignedCharArray> colors;
  colors->SetNumberOfComponents(3);
  for (const SnapshotLine& line : lines) {
    cells->InsertNextCell(2);
    for (const Vec3& end : {line.from, line.to}) {
      cells->InsertCellPoint(points->InsertNextPoint(end.data()));
      colors->InsertNextTypedTuple(scale.color(line.value).data());
    }
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetLines(cells);
  data->GetPointData()->SetScalars(colors);
  return data;
}

/// Without the steps at which it stands still, which have no direction.
vtkNew<vtkPolyData> polyline(const Points& path) {
  vtkNew<vtkPoints> points;
  for (std::size_t i = 0; i < path.size(); ++i)
    if (i == 0 || path[i] != path[i - 1]) points->InsertNextPoint(path[i].data());
  vtkNew<vtkCellArray> cells;
  cells->InsertNextCell(static_cast<int>(points->GetNumberOfPoints()));
  for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i) cells->InsertCellPoint(i);
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetLines(cells);
  return data;
}

}  // namespace

void add_lines(vtkRenderer& renderer, const Snapshot& snapshot, const ColorScale& scale,
               double width) {
  if (snapshot.lines.empty()) return;
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data_of(snapshot.lines, scale));
  vtkProperty& look = add_actor(renderer, *mapper, palette::paper);
  look.LightingOff();
  look.SetLineWidth(static_cast<float>(width));
}

void add_curves(vtkRenderer& renderer, const Snapshot& snapshot, const ColorScale& scale,
                double thickness) {
  if (snapshot.curves.empty()) return;
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> cells;
  std::vector<double> values;
  for (const SnapshotCurve& curve : snapshot.curves) {
    cells->InsertNextCell(static_cast<int>(curve.points.size()));
    for (const Vec3& point : curve.points)
      cells->InsertCellPoint(points->InsertNextPoint(point.data()));
    values.insert(values.end(), curve.values.begin(), curve.values.end());
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetLines(cells);
  data->GetPointData()->AddArray(named_values("value", values));
  vtkNew<vtkTubeFilter> tubes;
  tubes->SetInputData(data);
  tubes->SetRadius(thickness / 2);
  tubes->SetNumberOfSides(12);
  tubes->CappingOn();
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(tubes->GetOutputPort());
  show_values(*mapper, scale);
  add_actor(renderer, *mapper, palette::paper);
}

void add_traces(vtkRenderer& renderer, const Snapshot& snapshot, double thickness) {
  for (std::size_t k = 0; k < snapshot.traces.size(); ++k) {
    const Points& path = snapshot.traces[k].path;
    if (path.empty()) continue;
    const Color& color = palette::traces[k % palette::traces.size()];
    add_balls(renderer, {path.back()}, snapshot.radius, color);
    const auto line = polyline(path);
    if (line->GetNumberOfPoints() < 2) continue;
    add_tubes(renderer, line, thickness / 2, color);
  }
}

}  // namespace sinew

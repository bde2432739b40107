// SPDX-License-Identifier: GPL-3.0-or-later
#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSelectEnclosedPoints.h>

#include "bench/vtk_inside.h"

namespace sinew {
namespace {

vtkNew<vtkPoints> vtk_points(const Points& points) {
  vtkNew<vtkPoints> result;
  result->SetDataTypeToDouble();
  for (const Vec3& p : points) result->InsertNextPoint(p.data());
  return result;
}

}  // namespace

std::size_t inside_by_vtk(const Triangles& surface, const Points& points) {
  vtkNew<vtkCellArray> faces;
  for (const auto& face : surface.faces) {
    const vtkIdType corners[] = {face[0], face[1], face[2]};
    faces->InsertNextCell(3, corners);
  }
  vtkNew<vtkPolyData> mesh, queries;
  mesh->SetPoints(vtk_points(surface.points));
  mesh->SetPolys(faces);
  queries->SetPoints(vtk_points(points));
  vtkNew<vtkSelectEnclosedPoints> select;
  select->SetSurfaceData(mesh);
  select->SetInputData(queries);
  select->Update();
  std::size_t count = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    count += select->IsInside(static_cast<vtkIdType>(i));
  return count;
}

}  // namespace sinew

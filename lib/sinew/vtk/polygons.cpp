// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/vtk/data_sets.h>

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkDataSetAttributes.h>
#include <vtkDataSetSurfaceFilter.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <array>
#include <limits>
#include <map>
#include <string>

#include <sinew/core/error.h>

namespace sinew {
namespace {

/// The corners of a cell.
struct Corners {
  vtkIdType count;
  const vtkIdType* ids;

  int operator[](vtkIdType k) const { return static_cast<int>(ids[k]); }
};

Error damaged(const std::string& what) {
  return bad_input("the data set of VTK has a " + what,
                   "give each cell at least 3 of the data set's points");
}

/// Every second triangle of a strip is turned the other way.
void add_strip(const Corners& strip, PolygonSoup& soup) {
  for (vtkIdType k = 0; k + 2 < strip.count; ++k) {
    const vtkIdType odd = k % 2;
    soup.polygons.push_back({strip[k], strip[k + 1 + odd], strip[k + 2 - odd]});
  }
}

void add_polygon(const Corners& polygon, PolygonSoup& soup) {
  std::vector<int>& corners = soup.polygons.emplace_back();
  corners.reserve(static_cast<std::size_t>(polygon.count));
  for (vtkIdType k = 0; k < polygon.count; ++k) corners.push_back(polygon[k]);
}

/// The cells of a vtkPolyData that are neither copies of another piece's nor hidden.
class Shown {
 public:
  explicit Shown(vtkPolyData& shape) : flags_(shape.GetCellGhostArray()) {}

  bool operator()(vtkIdType cell) {
    constexpr int left_out = vtkDataSetAttributes::DUPLICATECELL | vtkDataSetAttributes::HIDDENCELL;
    const bool shown = flags_ == nullptr || (flags_->GetValue(cell) & left_out) == 0;
    dropped_ += !shown;
    return shown;
  }

  std::size_t dropped() const { return dropped_; }

 private:
  vtkUnsignedCharArray* flags_;
  std::size_t dropped_ = 0;
};

/// `first`: the number of the first of these cells among all.
void add_cells(vtkCellArray& cells, const std::string& kind, vtkIdType first, Shown& shown,
               void (*add)(const Corners&, PolygonSoup&), PolygonSoup& soup) {
  const auto points = static_cast<vtkIdType>(soup.points.size());
  const auto each = vtk::TakeSmartPointer(cells.NewIterator());
  for (each->GoToFirstCell(); !each->IsDoneWithTraversal(); each->GoToNextCell()) {
    Corners cell{};
    each->GetCurrentCell(cell.count, cell.ids);
    const std::string name = kind + ' ' + std::to_string(each->GetCurrentCellId());
    if (cell.count < 3)
      throw damaged(name + " of " + std::to_string(cell.count) + " points, too few");
    for (vtkIdType k = 0; k < cell.count; ++k)
      if (cell.ids[k] < 0 || cell.ids[k] >= points)
        throw damaged(name + " with point " + std::to_string(cell.ids[k]) + " of " +
                      std::to_string(points));
    if (shown(first + each->GetCurrentCellId())) add(cell, soup);
  }
}

Points points_of(vtkPolyData& shape) {
  const vtkIdType count = shape.GetNumberOfPoints();
  if (count > std::numeric_limits<int>::max())
    throw bad_input("the data set of VTK has " + std::to_string(count) + " points, over 2^31",
                    "make it coarser: vtkQuadricClustering");
  Points points(static_cast<std::size_t>(count));
  for (vtkIdType i = 0; i < count; ++i) {
    Vec3& point = points[static_cast<std::size_t>(i)];
    shape.GetPoint(i, point.data());
    if (!point.allFinite())
      throw bad_input("point " + std::to_string(i) + " of the data set of VTK is not finite",
                      "give its points finite coordinates");
  }
  return points;
}

void tell_of_ghosts(std::size_t dropped, std::size_t all, PolygonSoup& soup) {
  if (dropped > 0)
    soup.warning = "cells that are left out, as copies of another piece's (ghosts) or hidden: " +
                   std::to_string(dropped) + " of " + std::to_string(all);
}

PolygonSoup soup_of(vtkPolyData& shape) {
  const vtkIdType cells = shape.GetNumberOfPolys() + shape.GetNumberOfStrips();
  if (shape.GetNumberOfPoints() == 0 && cells == 0)
    throw bad_input("the data set of VTK is empty",
                    "call Update() on the source or filter that makes it, and check its input");
  if (cells == 0)
    throw bad_input("the data set of VTK has points, and no polygons or triangle strips",
                    "give the surface of the body: vertices and lines have no inside");
  PolygonSoup soup{points_of(shape), {}};
  soup.polygons.reserve(static_cast<std::size_t>(cells));
  Shown shown(shape);
  const vtkIdType before = shape.GetNumberOfVerts() + shape.GetNumberOfLines();
  add_cells(*shape.GetPolys(), "polygon", before, shown, add_polygon, soup);
  add_cells(*shape.GetStrips(), "strip", before + shape.GetNumberOfPolys(), shown, add_strip, soup);
  tell_of_ghosts(shown.dropped(), static_cast<std::size_t>(cells), soup);
  return soup;
}

/// Pieces may have points of their own where they meet.
void join_equal_points(vtkUnstructuredGrid& grid) {
  std::map<std::array<double, 3>, vtkIdType> places;
  vtkDataArray& ids = *grid.GetCells()->GetConnectivityArray();
  for (vtkIdType i = 0; i < ids.GetNumberOfTuples(); ++i) {
    const auto id = static_cast<vtkIdType>(ids.GetComponent(i, 0));
    std::array<double, 3> place{};
    grid.GetPoint(id, place.data());
    ids.SetComponent(i, 0, static_cast<double>(places.emplace(place, id).first->second));
  }
}

/// Without the cells that are copies of another piece's.
vtkSmartPointer<vtkDataSet> own_cells(vtkDataSet& shape) {
  auto* grid = vtkUnstructuredGrid::SafeDownCast(&shape);
  if (grid == nullptr || grid->GetCellGhostArray() == nullptr) return &shape;
  auto own = vtkSmartPointer<vtkUnstructuredGrid>::New();
  own->ShallowCopy(grid);
  own->RemoveGhostCells();
  if (own->GetNumberOfCells() < grid->GetNumberOfCells()) join_equal_points(*own);
  return own;
}

}  // namespace

PolygonSoup polygons_of(vtkDataSet& shape) {
  if (auto* polygons = vtkPolyData::SafeDownCast(&shape)) return soup_of(*polygons);
  if (vtkImageData::SafeDownCast(&shape) != nullptr)
    throw bad_input("the data set of VTK is an image, whose surface is a box",
                    "give a contour of it: vtkFlyingEdges3D or vtkContourFilter");
  vtkNew<vtkDataSetSurfaceFilter> surface;
  const vtkSmartPointer<vtkDataSet> own = own_cells(shape);
  surface->SetInputData(own);
  surface->Update();
  PolygonSoup soup = soup_of(*surface->GetOutput());
  if (soup.warning.empty())
    tell_of_ghosts(static_cast<std::size_t>(shape.GetNumberOfCells() - own->GetNumberOfCells()),
                   static_cast<std::size_t>(shape.GetNumberOfCells()), soup);
  return soup;
}

}  // namespace sinew

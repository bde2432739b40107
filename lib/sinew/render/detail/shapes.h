// SPDX-License-Identifier: GPL-3.0-or-later
// Plain values as VTK's data, and simple shapes as actors.
//
//     add_tubes(renderer, net(points, edges), 0.01, palette::bone);
#pragma once

#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <array>
#include <vector>

#include <sinew/core/color.h>
#include <sinew/core/vector.h>
#include <sinew/render/shading.h>
#include <sinew/render/snapshot.h>

class vtkMapper;
class vtkPolyDataMapper;
class vtkProperty;
class vtkRenderer;

namespace sinew {

vtkNew<vtkPoints> vtk_points(const Points& points);

template <class Index, std::size_t N>
vtkNew<vtkCellArray> vtk_cells(const std::vector<std::array<Index, N>>& cells) {
  vtkNew<vtkCellArray> out;
  for (const auto& cell : cells) {
    out->InsertNextCell(static_cast<int>(N));
    for (const Index point : cell) out->InsertCellPoint(static_cast<vtkIdType>(point));
  }
  return out;
}

/// Edges between points.
vtkNew<vtkPolyData> net(const Points& points, const std::vector<Shading::Edge>& edges);

/// `values`: of the surface's points. `source`: surface's point behind each point; none: itself.
vtkNew<vtkDoubleArray> named_values(const char* name, const std::vector<double>& values,
                                    const std::vector<int>& source = {});

/// Shows the point array "value". Values between points are interpolated, not colors, which the
/// scale may lack.
void show_values(vtkPolyDataMapper& mapper, const ColorScale& scale);

/// Lit as all that is drawn; returns its look.
vtkProperty& add_actor(vtkRenderer& renderer, vtkMapper& mapper, const Color& color);

/// Without light and shadows, `width` rendered pixels wide.
void add_flat_lines(vtkRenderer& renderer, vtkPolyData* lines, const Color& color, double opacity,
                    double width);

/// Along lines, or from each point to the next of a pair; `radius` in m.
void add_tubes(vtkRenderer& renderer, vtkPolyData* lines, double radius, const Color& color);
void add_tubes(vtkRenderer& renderer, const Points& ends, double radius, const Color& color);

void add_balls(vtkRenderer& renderer, const Points& centers, double radius, const Color& color);

}  // namespace sinew

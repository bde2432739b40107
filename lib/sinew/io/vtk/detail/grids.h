// SPDX-License-Identifier: GPL-3.0-or-later
// The grids of VTK's files, and the surfaces that they have: the cells of polygons and of
// unstructured grids, and images whose values change their sign at the surface.
//
//     soup.polygons = surface_of(cells, soup.points.size());
//     const PolygonSoup other = zero_level({{64, 64, 64}, origin, axes, distances});
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <sinew/core/error.h>
#include <sinew/core/triangles.h>

namespace sinew {

// Cells.

struct VtkCells {
  std::vector<int> types;          ///< VTK's numbers, one per cell
  std::vector<std::int64_t> ends;  ///< ends of each cell's points, in `points`
  std::vector<std::int64_t> points;
  std::vector<std::uint8_t> ghosts = {};  ///< VTK's flags of each cell, none of those at the end
};

// VTK's arrays of flags: of copies of another piece's cells, and of hidden ones.
inline constexpr std::string_view ghost_array = "vtkGhostType", old_ghost_array = "vtkGhostLevels";

// VTK's numbers of cells that polygons of a vtkPolyData have.
inline constexpr int vtk_strip = 6, vtk_polygon = 7;

/// Finds the outer faces of grids with volume cells: those of one cell only. For others, the cells
/// that are surfaces. The nodes at the middle of sides of quadratic cells become corners. Throws
/// bad input for cells of other kinds, damaged ones, and where there is neither.
std::vector<std::vector<int>> surface_of(const VtkCells& cells, std::size_t points);

/// The surface and its points. Cells that are copies or hidden are left out, with a warning that
/// counts them. `pieces`: points of several pieces, which meet at equal points of their own.
PolygonSoup soup_of(Points points, VtkCells cells, bool pieces);

/// Adds to what is told of a file.
void add_warning(PolygonSoup& soup, const std::string& warning);

// Images.

struct LevelSet {
  std::array<int, 3> size{};        ///< samples along each axis
  Vec3 origin = Vec3::Zero();       ///< origin of the first one
  Mat3 axes = Mat3::Identity();     ///< columns: from one sample to the next along each axis
  std::vector<double> values = {};  ///< the first axis varies fastest
  std::size_t bytes = 0;            ///< size of the values in the file, uncompressed
};

/// Values at the centers of the cells of an image, which has a sample less along each axis.
void move_to_cells(LevelSet& image);

/// For an image whose values reach from `low` to `high` and enclose nothing.
Error no_surface(double low, double high);

/// Quadrilaterals around what has the sign that fewer samples of the image's border have (where
/// that is none at all, the other sign): one corner in each cell through which the surface passes,
/// moved to the zero level of the trilinear interpolation, as in dual contouring. Where all values
/// have one sign, as in CT and MRI, the level halfway between the extremes serves, with a warning.
/// Where the inside reaches the border, the surface is closed along it, with a warning. Throws bad
/// input for images of fewer than two samples along an axis, values that are not finite, where none
/// is inside, and where the surface passes through so many cells that it is of noise.
PolygonSoup zero_level(LevelSet image);

// Legacy files (.vtk), as text or binary, of versions up to 5.

/// Throws bad input where a file that begins so is none of them.
void check_start_of_legacy(std::string_view text);

/// Reads what read_vtk_mesh() does. Counts are checked against the file's length before anything is
/// allocated. Throws bad input.
PolygonSoup legacy_surface(std::string_view text);

}  // namespace sinew

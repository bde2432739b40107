// SPDX-License-Identifier: GPL-3.0-or-later
// The grids of VTK's files, and the surfaces that they have: the cells of polygons and of
// unstructured grids, and images whose values change their sign at the surface.
//
//     soup.polygons = surface_of(cells, soup.points.size());
//     const PolygonSoup other = level_surface({{64, 64, 64}, origin, axes, distances}, 0);
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <sinew/core/error.h>
#include <sinew/core/triangles.h>
#include <sinew/io/vtk/vtk_mesh.h>

namespace sinew {

// Cells.

struct VtkCells {
  std::vector<int> types;          ///< VTK's numbers, one per cell
  std::vector<std::int64_t> ends;  ///< ends of each cell's points, in `points`
  std::vector<std::int64_t> points;
  std::vector<std::uint8_t> ghosts = {};     ///< VTK's flags of each cell, none of those at the end
  std::vector<std::int64_t> materials = {};  ///< number of each cell's material; empty: not said
};

/// A grid whose pieces, if several, meet at equal points of their own.
struct VtkGrid {
  Points points;
  VtkCells cells;
  bool pieces = false;
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
/// counts them.
PolygonSoup soup_of(VtkGrid grid);

/// Whether an array of cells has the numbers of their materials, by the names that meshers and
/// finite element programs give it.
bool names_materials(std::string_view array);

/// The outer faces of the volume cells of each material, by its number.
std::vector<MaterialSurface> materials_of(VtkGrid grid);

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

/// For a level of a file without an image.
Error no_image();

/// Values at the centers of the cells of an image, which has a sample less along each axis.
void move_to_cells(LevelSet& image);

/// For an image whose values reach from `low` to `high` and enclose nothing.
Error no_surface(double low, double high);

/// Quadrilaterals around what lies on the side of the level that fewer samples of the image's
/// border have (where that is none at all, the other side): one corner in each cell through which
/// the surface passes, moved to the level of the trilinear interpolation, as in dual contouring.
/// None: level 0; where all values have one sign, as in CT and MRI, the one halfway between the
/// extremes, with a warning. Where the inside reaches the border, the surface is closed along it,
/// with a warning. Throws bad input for images of fewer than two samples along an axis, values that
/// are not finite, where none is inside, and where the surface passes through so many cells that it
/// is of noise.
PolygonSoup level_surface(LevelSet image, std::optional<double> level);

// Legacy files (.vtk), as text or binary, of versions up to 5.

/// Throws bad input where a file that begins so is none of them.
void check_start_of_legacy(std::string_view text);

/// What a legacy file holds: a grid, or an image.
struct LegacyContent {
  VtkGrid grid;
  std::optional<LevelSet> image;
};

/// Reads all that read_vtk_mesh() needs. Counts are checked against the file's length before
/// anything is allocated. Throws bad input.
LegacyContent legacy_content(std::string_view text);

}  // namespace sinew

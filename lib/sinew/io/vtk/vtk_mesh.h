// SPDX-License-Identifier: GPL-3.0-or-later
// Reads surfaces from VTK's files: .vtp, .vtu, .vti and legacy .vtk.
//
//     const PolygonSoup soup = read_vtk_mesh("organ.vtu");
//
// VTK's own readers take damaged counts and indices on trust and end the program with them, so
// these formats are read here.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include <sinew/core/triangles.h>

namespace sinew {

/// Polygons and strips; of unstructured grids the outer faces of volume cells, or else the surface
/// cells; of images the `level` (grids.h) of their active or first scalars. Polygons in the
/// order of the file. XML as in vtu.h; legacy files as text or binary. Throws bad input, naming the
/// file, for anything else, however damaged, and for a level of what is no image.
PolygonSoup read_vtk_mesh(const std::filesystem::path& path, std::optional<double> level = {});

/// The surface of the cells of one material.
struct MaterialSurface {
  std::int64_t number;  ///< value of the array that numbers materials
  PolygonSoup surface;
};

/// The volume cells of a grid by their material, ascending; at most 64 of them. Empty where no
/// array of the cells names one (`gmsh:physical`, `MaterialIds`, `PartId` and the like). Throws as
/// read_vtk_mesh() does.
std::vector<MaterialSurface> read_vtk_materials(const std::filesystem::path& path);

}  // namespace sinew

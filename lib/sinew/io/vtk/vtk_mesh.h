// SPDX-License-Identifier: GPL-3.0-or-later
// Reads surfaces from VTK's files: .vtp, .vtu, .vti and legacy .vtk.
//
//     const PolygonSoup soup = read_vtk_mesh("organ.vtu");
//
// VTK's own readers take damaged counts and indices on trust and end the program with them, so
// these formats are read here.
#pragma once

#include <filesystem>

#include <sinew/core/triangles.h>

namespace sinew {

/// Polygons and strips; of unstructured grids the outer faces of volume cells, or else the surface
/// cells; of images the zero level (grids.h) of their active or first scalars. Polygons in the
/// order of the file. XML as in vtu.h; legacy files as text or binary. Throws bad input, naming the
/// file, for anything else, however damaged.
PolygonSoup read_vtk_mesh(const std::filesystem::path& path);

}  // namespace sinew

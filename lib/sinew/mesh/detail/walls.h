// SPDX-License-Identifier: GPL-3.0-or-later
// Walls: faces that touching solids share. Each solid has a copy of its own, and the two point in
// opposite directions, so that they bound nothing, but part the solids.
#pragma once

#include <vector>

#include <sinew/core/triangles.h>
#include <sinew/mesh/surface.h>

namespace sinew {

/// What the distinct faces of a mesh are, some of which stand in its file in both directions.
struct FaceKinds {
  std::vector<bool> wall;  ///< per face
  /// Groups of faces in both directions that meet no others: a two-sided mesh, or the skin of a
  /// solid in a cavity that it fills.
  std::vector<std::vector<int>> alone;
};

/// Tells walls from skin that stands in a file in both directions (`opposed`, per face). Connected
/// ones are walls where that leaves fewer edges of an odd number of faces: a skin without gaps.
FaceKinds kinds_of(const Triangles& faces, const std::vector<bool>& opposed);

/// Sets Surface::walls, and parts the components along them. At an edge of walls, those faces
/// belong together that bound one wedge of material; where their order around the edge makes no
/// sense, all of them.
void part(Surface& surface, Triangles walls);

}  // namespace sinew

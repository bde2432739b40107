// SPDX-License-Identifier: GPL-3.0-or-later
// Finite elements in a closed surface: hexahedra in a box along the axes, tetrahedra in any other.
//
//     const VolumeMesh mesh = box ? hexahedra(*box, size) : tetrahedra(surface, size);
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <sinew/core/triangles.h>
#include <sinew/core/volume_mesh.h>

namespace sinew {

/// The box that a closed surface is, where its sides lie along the axes.
std::optional<Box> axis_box(const Triangles& surface);

/// Places along x, y and z at which elements are to meet.
using Cuts = std::array<std::vector<double>, 3>;

/// Hexahedra of 20 nodes with sides of at most `size` (m, > 0). Cuts nearer than a tenth of it to a
/// side of the box, or to an earlier cut, are left out.
VolumeMesh hexahedra(const Box& box, double size, const Cuts& cuts = {});

/// Tetrahedra of 10 nodes with sides of about `size` (m, > 0) and straight edges, by CGAL's mesher
/// (Jamin, Alliez, Yvinec, Boissonnat 2015). Edges of the surface sharper than 30 degrees are kept.
/// Repeatable. Throws bad input for a surface that is open or intersects itself.
VolumeMesh tetrahedra(const Triangles& surface, double size);

}  // namespace sinew

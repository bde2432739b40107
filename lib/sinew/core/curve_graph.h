// SPDX-License-Identifier: GPL-3.0-or-later
// The curves to which the skin of a body contracts: what mesh finds and rig makes bones of.
//
//     const CurveGraph graph = curve_skeleton(surface.triangles);
//     const LimbTree limbs = limbs_of(graph);
#pragma once

#include <array>
#include <vector>

#include <sinew/core/vector.h>

namespace sinew {

/// Points inside a body, joined to curves along its limbs. May have several components and cycles.
struct CurveGraph {
  Points points;                          ///< n x 3, m
  std::vector<std::array<int, 2>> links;  ///< between points, each once
  std::vector<double> inner;              ///< n, distance of the points from the surface, m
  Points skin;                            ///< m x 3, points of the surface, m
  std::vector<int> owner;                 ///< m, the point to which each of the skin contracts
};

}  // namespace sinew

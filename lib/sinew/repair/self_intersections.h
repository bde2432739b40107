// SPDX-License-Identifier: GPL-3.0-or-later
// Self-intersections: faces that meet elsewhere than at the corners and edges they share (exact, by
// CGAL's predicates), of any surface: open, crowded, a soup.
//
//     const std::size_t pairs = self_intersections(surface).pairs;
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <sinew/core/triangles.h>
#include <sinew/mesh/face_tree.h>

namespace sinew {

struct SelfIntersections {
  std::size_t pairs = 0;          ///< pairs of faces found
  std::array<int, 2> first = {};  ///< the first pair in the order of faces
  bool complete = true;           ///< false when the search stopped early
  std::vector<bool> faces;        ///< per face, whether it is in a pair found
};

/// Bound for long thin faces, of which all may meet each other.
inline constexpr std::size_t max_pairs = 100000;

/// Searches until `most` pairs are found or 2 10^6 pairs of faces whose boxes meet are tested (20
/// per face, if that is more): long thin faces may have as many as the square of their number.
/// Faces without area are left out. Where one lies along a side of another face, with a point
/// between the side's ends, the other counts as two faces that share that point.
SelfIntersections self_intersections(const Triangles& surface, std::size_t most = max_pairs);

/// The same of a surface whose boxes are there already.
SelfIntersections self_intersections(const FaceTree& tree);

}  // namespace sinew

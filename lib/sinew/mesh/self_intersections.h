// SPDX-License-Identifier: GPL-3.0-or-later
// Faces that cut or touch each other elsewhere than at the corners and edges they share (exact, by
// CGAL's predicates). Any surface will do: open, crowded, a soup.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <sinew/core/triangles.h>

namespace sinew {

struct SelfIntersections {
  std::size_t pairs = 0;          ///< pairs of faces found
  std::array<int, 2> first = {};  ///< the pair of lowest faces among them
  bool complete = true;           ///< false when the search stopped early
  std::vector<bool> faces;        ///< per face, whether it is in a pair found
};

/// Searches until `most` pairs are found or 2 10^6 pairs of faces whose boxes meet are tested (20
/// per face, if that is more): of long thin faces that may be the square of their number. A face
/// without area is left out; it lies along a side of another one, with a point between its ends:
/// there the other counts as two faces that share that point.
SelfIntersections self_intersections(const Triangles& surface, std::size_t most = 100000);

// Faces without area, told exactly by CGAL's predicates.

/// Per face, whether its corners lie on one line.
std::vector<bool> flat_faces(const Triangles& surface);

}  // namespace sinew

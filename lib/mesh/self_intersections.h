// SPDX-License-Identifier: GPL-3.0-or-later
// Faces that cut or touch each other elsewhere than at the corners and edges they share (exact, by
// CGAL's predicates): there the inside is not defined by counting crossings.
#pragma once

#include <array>
#include <cstddef>

#include "core/triangles.h"

namespace sinew {

struct SelfIntersections {
  std::size_t pairs = 0;          ///< pairs of faces found
  std::array<int, 2> first = {};  ///< the pair of lowest faces among them
  bool complete = true;           ///< false when the search stopped at `most`
  std::size_t flat = 0;           ///< faces without area: left out
};

/// Searches until `most` pairs are found. A face without area lies along a side of another one,
/// with a point between its ends: there the other counts as two faces that share that point.
SelfIntersections self_intersections(const Triangles& surface, std::size_t most = 1000);

}  // namespace sinew

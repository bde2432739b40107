// SPDX-License-Identifier: GPL-3.0-or-later
// The holes of a surface, as loops of edges to be closed.
//
//     const std::vector<Hole> holes = holes_of(surface);
#pragma once

#include <vector>

#include <sinew/core/triangles.h>

namespace sinew {

/// An edge that a new face must traverse from `from` to `to`: the faces at it traverse it once more
/// in the other direction.
struct HoleEdge {
  int from, to;
  int opposite;  ///< the third corner of one of these faces
};

/// A closed path along edges, three or more. A point occurs twice where a hole touches itself.
using Hole = std::vector<HoleEdge>;

/// All open edges, each as many times as it is open, as holes ordered by their first edge. Where
/// holes touch at a point, each continues along the next open edge across the hole, seen along the
/// point's normal: so none encircles an island of faces between holes.
std::vector<Hole> holes_of(const Triangles& surface);

}  // namespace sinew

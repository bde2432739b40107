// SPDX-License-Identifier: GPL-3.0-or-later
// The holes of a surface, as they are to be closed.
#pragma once

#include <vector>

#include <sinew/core/triangles.h>

namespace sinew {

/// An edge that new faces are to go along from `from` to `to`: the faces at it go back once more.
struct HoleEdge {
  int from, to;
  int opposite;  ///< the third corner of one of these faces
};

/// A closed way along edges, three or more. A point comes twice where a hole touches itself.
using Hole = std::vector<HoleEdge>;

/// All open edges, each as many times as it is open, as holes by their first edge. Where holes
/// touch at a point each goes on along the next open edge across the hole, seen along the point's
/// normal: so none goes around an island of faces that lies between holes.
std::vector<Hole> holes_of(const Triangles& surface);

}  // namespace sinew

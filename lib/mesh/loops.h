// SPDX-License-Identifier: GPL-3.0-or-later
// The border of a surface as closed loops.
#pragma once

#include <vector>

namespace sinew {

/// An edge that faces of a group go along once more from `from` to `to` than back.
struct BorderEdge {
  int group, from, to;
};

struct Loop {
  int group;
  std::vector<int> points;  ///< three or more, none twice; the last joins the first
};

/// Splits the border edges (an edge that counts twice stands there twice) into loops without
/// repeated points: a walk along the edges, each point's lowest next one first, loses a loop where
/// it meets itself. In every group as many edges must leave each point as come to it: so it is for
/// the border of any set of triangles.
std::vector<Loop> simple_loops(std::vector<BorderEdge> edges);

}  // namespace sinew

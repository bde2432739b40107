// SPDX-License-Identifier: GPL-3.0-or-later
// The edges of a surface and the faces at them, and its border as closed loops.
//
//     const std::vector<EdgeUse> uses = edge_uses(surface);
//     const Border border = border_of(surface, uses, border_loops(uses));
#pragma once

#include <array>
#include <span>
#include <vector>

#include <sinew/core/triangles.h>

namespace sinew {

// Which faces meet at which edges.

/// One side of a face, as an undirected edge low-high.
struct EdgeUse {
  int low, high;  ///< points
  int face;
  bool forward;  ///< whether the face goes from low to high
};

/// Every side of every face, sorted by edge and then by face.
std::vector<EdgeUse> edge_uses(const Triangles& surface);

/// Calls visit(span) for the uses of each edge.
template <class Visit>
void for_each_edge(std::span<const EdgeUse> uses, Visit&& visit) {
  for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
    while (end < uses.size() && uses[end].low == uses[begin].low &&
           uses[end].high == uses[begin].high)
      ++end;
    visit(uses.subspan(begin, end - begin));
  }
}

// The border of a surface as closed loops.

/// An edge that the faces of a group traverse once more from `from` to `to` than back.
struct BorderEdge {
  int group, from, to;
};

struct Loop {
  int group;
  std::vector<int> points;  ///< three or more, each once; the last is joined to the first
};

/// Splits the border edges (an edge that counts twice is given twice) into loops without repeated
/// points: a walk along the edges, each point's lowest successor first, splits off a loop where it
/// meets itself. In every group as many edges must leave each point as arrive there, which holds
/// for the border of any set of triangles.
std::vector<Loop> simple_loops(std::vector<BorderEdge> edges);

/// The border of a surface. An edge is open where the numbers of faces that traverse it forward and
/// backward differ. Open edges form closed loops: the holes.
struct Border {
  std::size_t holes = 0;          ///< loops
  std::size_t edges = 0;          ///< open edges
  std::size_t crowded_edges = 0;  ///< edges of three or more faces, open or not
  double length = 0;              ///< total length of the open edges, m
};

/// Forward minus backward uses of one edge.
int net_count(std::span<const EdgeUse> use);

/// The holes' edges, in the direction of the faces at them: loops of group 0. The cap of loop i is
/// the i-th one in Surface::caps.
std::vector<Loop> border_loops(std::span<const EdgeUse> uses);

/// Counts and lengths of the border with these loops.
Border border_of(const Triangles& surface, std::span<const EdgeUse> uses,
                 std::span<const Loop> loops);

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// Which faces meet at which edges.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/triangles.h"

namespace sinew {

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

}  // namespace sinew

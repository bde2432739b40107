// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/border.h"

#include <cstdlib>

namespace sinew {

int net_count(std::span<const EdgeUse> use) {
  int count = 0;
  for (const EdgeUse& side : use) count += side.forward ? 1 : -1;
  return count;
}

std::vector<Loop> border_loops(std::span<const EdgeUse> uses) {
  std::vector<BorderEdge> border;
  for_each_edge(uses, [&](std::span<const EdgeUse> use) {
    const int count = net_count(use), low = use[0].low, high = use[0].high;
    border.insert(border.end(), std::abs(count),
                  count > 0 ? BorderEdge{0, low, high} : BorderEdge{0, high, low});
  });
  return simple_loops(std::move(border));
}

Border border_of(const Triangles& surface, std::span<const EdgeUse> uses,
                 std::span<const Loop> loops) {
  Border border;
  border.holes = loops.size();
  for_each_edge(uses, [&](std::span<const EdgeUse> use) {
    border.crowded_edges += use.size() > 2;
    if (net_count(use) == 0) return;
    ++border.edges;
    border.length += (surface.points[use[0].high] - surface.points[use[0].low]).norm();
  });
  return border;
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/edges.h"

#include <algorithm>
#include <tuple>

namespace sinew {
namespace {

template <class Visit>
void for_each_side(const std::vector<std::array<int, 3>>& faces, Visit&& visit) {
  for (std::size_t i = 0; i < faces.size(); ++i)
    for (int side = 0; side < 3; ++side) {
      const int from = faces[i][side], to = faces[i][(side + 1) % 3];
      visit(EdgeUse{std::min(from, to), std::max(from, to), static_cast<int>(i), from < to});
    }
}

}  // namespace

std::vector<EdgeUse> edge_uses(const Triangles& surface) {
  std::vector<std::size_t> end(surface.points.size() + 1, 0);  // of each low point's uses
  for_each_side(surface.faces, [&](const EdgeUse& use) { ++end[use.low + 1]; });
  for (std::size_t i = 1; i < end.size(); ++i) end[i] += end[i - 1];
  std::vector<EdgeUse> uses(end.back());
  for_each_side(surface.faces, [&](const EdgeUse& use) { uses[end[use.low]++] = use; });
  const auto before = [](const EdgeUse& a, const EdgeUse& b) {
    return std::tie(a.high, a.face) < std::tie(b.high, b.face);
  };
  for (std::size_t begin = 0; begin < uses.size(); begin = end[uses[begin].low])
    std::sort(uses.begin() + static_cast<std::ptrdiff_t>(begin),
              uses.begin() + static_cast<std::ptrdiff_t>(end[uses[begin].low]), before);
  return uses;
}

}  // namespace sinew

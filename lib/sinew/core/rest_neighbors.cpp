// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/rest_neighbors.h>

#include <algorithm>

namespace sinew {
namespace {

/// The pairs of `lists` for which keeps(i, j), in their order.
template <class Keeps>
NeighborLists kept(const NeighborLists& lists, const Keeps& keeps) {
  NeighborLists some;
  some.first.reserve(lists.size() + 1);
  some.first.push_back(0);
  for (std::uint32_t i = 0; i < lists.size(); ++i) {
    for (const std::uint32_t j : lists.of(i))
      if (keeps(i, j)) some.neighbor.push_back(j);
    some.first.push_back(static_cast<std::uint32_t>(some.neighbor.size()));
  }
  some.neighbor.shrink_to_fit();
  return some;
}

}  // namespace

RestNeighbors rest_neighbors(const Points& rest, double radius, bool with_second) {
  const double nearest = rest_neighbor_range(radius);
  if (!with_second) return {neighbors_within(rest, nearest), {}};
  RestNeighbors near;
  near.with_second = neighbors_within(rest, second_neighbor_range * radius);
  near.nearest = kept(near.with_second, [&](std::uint32_t i, std::uint32_t j) {
    return (rest[j] - rest[i]).squaredNorm() < nearest * nearest;
  });
  return near;
}

NeighborLists second_neighbors(const RestNeighbors& near) {
  return kept(near.with_second, [&](std::uint32_t i, std::uint32_t j) {
    const auto nearest = near.nearest.of(i);
    return !std::binary_search(nearest.begin(), nearest.end(), j);
  });
}

}  // namespace sinew

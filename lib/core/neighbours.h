// SPDX-License-Identifier: GPL-3.0-or-later
// Lists of the points within a distance of each point, all in one array, of any length.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vector.h"

namespace sinew {

/// Row i of a list of lists: the partners of point i, ascending.
struct NeighbourLists {
  std::vector<std::uint32_t> first;    ///< n + 1 long; row i is [first[i], first[i + 1])
  std::vector<std::uint32_t> partner;  ///< indices of points

  std::size_t size() const { return first.empty() ? 0 : first.size() - 1; }
  std::span<const std::uint32_t> of(std::size_t i) const {
    return {partner.data() + first[i], first[i + 1] - first[i]};
  }
};

/// Every pair closer than `range` (m), from both sides. Same answer as brute force. Throws bad
/// input for more than 2^32 of them. In parallel.
NeighbourLists neighbours_within(const Points& points, double range);

}  // namespace sinew

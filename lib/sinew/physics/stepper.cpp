// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/physics/stepper.h>

#include <algorithm>

namespace sinew {

BondRest::BondRest(const NeighborLists& nearest, const NeighborLists& second)
    : nearest_(nearest),
      second_(second),
      length_(nearest.neighbor.size() + second.neighbor.size(), 0) {}

void BondRest::set(std::int32_t i, std::int32_t j, bool nearest, double length) {
  const NeighborLists& lists = nearest ? nearest_ : second_;
  if (lists.size() == 0) return;
  const auto partners = lists.of(static_cast<std::size_t>(i));
  const auto at = std::lower_bound(partners.begin(), partners.end(), static_cast<std::uint32_t>(j));
  if (at == partners.end() || *at != static_cast<std::uint32_t>(j)) return;
  const std::size_t entry =
      lists.first[static_cast<std::size_t>(i)] + static_cast<std::size_t>(at - partners.begin());
  length_[(nearest ? 0 : nearest_.neighbor.size()) + entry] = length;
}

}  // namespace sinew

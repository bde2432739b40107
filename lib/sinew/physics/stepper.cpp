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

void check_branches(const SimulationState& state, std::size_t branches) {
  const auto finite = [](const std::vector<double>& values) {
    return std::all_of(values.begin(), values.end(), [](double one) { return std::isfinite(one); });
  };
  if (state.branch_clocks.size() != branches)
    throw not_a_state("its bonds have " + std::to_string(state.branch_clocks.size()) +
                      " branches, not " + std::to_string(branches));
  if (!finite(state.branch_clocks) || !finite(state.branch_stretches))
    throw not_a_state("a branch of a bond has no length");
}

}  // namespace sinew

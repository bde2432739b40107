// SPDX-License-Identifier: GPL-3.0-or-later
// Selects the differences of a block that belong in its list: those with a pair within range.
#pragma once

#include <sinew/kernel/vectors.h>

namespace sinew::kernel {

template <class L>
struct BlockPlaces {
  Place<L> here[Traits<typename L::Real>::block / L::width];

  SINEW_INLINE BlockPlaces(const PruneInput<typename L::Real>& input, std::size_t block) {
    const auto i = static_cast<std::ptrdiff_t>(block * Traits<typename L::Real>::block);
    for (int k = 0; k < Traits<typename L::Real>::block / L::width; ++k)
      here[k] = load_place<L>(input.state.x, i + k * L::width);
  }
};

/// Whether a pair of the lanes is within range; `masked`: not of all of them.
template <class L, bool masked>
SINEW_INLINE bool meets(const PruneInput<typename L::Real>& input, const BlockPlaces<L>& places,
                        std::size_t block, std::ptrdiff_t difference, std::uint32_t lanes) {
  constexpr int size = Traits<typename L::Real>::block;
  const typename L::V range2 = L::all(input.range2);
  const std::ptrdiff_t j = static_cast<std::ptrdiff_t>(block) * size + difference;
  bool found = false;
  for (int k = 0; k < size / L::width; ++k) {
    const Place<L> there = load_place<L>(input.state.x, j + k * L::width);
    typename L::V squared = squared_distance<L>(offset<L>(places.here[k], there));
    if constexpr (masked) squared = L::pick(L::mask(lanes >> (k * L::width)), squared, range2);
    found |= L::any(L::less(squared, range2));
  }
  return found;
}

template <class L>
std::size_t prune_list(const PruneInput<typename L::Real>& input, std::size_t block,
                       const Candidates& from, const Candidates& kept) {
  const BlockPlaces<L> places(input, block);
  std::size_t count = 0;
  if (from.lanes == nullptr) {
    for (std::size_t n = 0; n < from.count; ++n) {
      kept.value[count] = from.value[n];
      count += meets<L, false>(input, places, block, from.value[n], 0);
    }
    return count;
  }
  for (std::size_t n = 0; n < from.count; ++n) {
    kept.value[count] = from.value[n];
    kept.lanes[count] = from.lanes[n];
    count += meets<L, true>(input, places, block, from.value[n], from.lanes[n]);
  }
  return count;
}

}  // namespace sinew::kernel

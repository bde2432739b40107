// SPDX-License-Identifier: GPL-3.0-or-later
// Selects the differences of a block that belong in its list: those with a pair within range.
#pragma once

#include <sinew/physics/kernel/parts.h>

namespace sinew::kernel {

template <class L>
SINEW_INLINE bool meets(const PruneInput<typename L::Real>& input, const Place<L>* here,
                        std::ptrdiff_t i, std::ptrdiff_t difference) {
  constexpr int vectors = Traits<typename L::Real>::block / L::width;
  bool found = false;
  for (int k = 0; k < vectors; ++k) {
    const Place<L> there = load_place<L>(input.state.x, i + difference + k * L::width);
    const Triple<L> apart = offset<L>(here[k], there);
    found |= L::any(L::less(squared_distance<L>(apart), L::all(input.range2)));
  }
  return found;
}

template <class L, class Next>
SINEW_INLINE std::int32_t* prune_all(const PruneInput<typename L::Real>& input, std::size_t block,
                                     std::int64_t count, Next next, std::int32_t* kept) {
  constexpr int size = Traits<typename L::Real>::block;
  const auto i = static_cast<std::ptrdiff_t>(block) * size;
  Place<L> here[size / L::width];
  for (int k = 0; k < size / L::width; ++k)
    here[k] = load_place<L>(input.state.x, i + k * L::width);
  for (std::int64_t n = 0; n < count; ++n) {
    const std::int32_t difference = next(n);
    *kept = difference;  // without a branch: hits and misses alternate without a pattern
    kept += meets<L>(input, here, i, difference) && difference != 0;
  }
  return kept;
}

template <class L>
std::int32_t* prune_range(const PruneInput<typename L::Real>& input, std::size_t block,
                          std::int64_t from, std::int64_t to, std::int32_t* kept) {
  return prune_all<L>(
      input, block, to - from, [&](std::int64_t n) { return static_cast<std::int32_t>(from + n); },
      kept);
}

template <class L>
std::int32_t* prune_list(const PruneInput<typename L::Real>& input, std::size_t block,
                         const std::int32_t* begin, const std::int32_t* end, std::int32_t* kept) {
  return prune_all<L>(
      input, block, end - begin, [&](std::int64_t n) { return begin[n]; }, kept);
}

}  // namespace sinew::kernel

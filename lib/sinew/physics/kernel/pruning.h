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

// Displacements of particles in their co-moving frames.

namespace sinew::kernel {

/// Coordinates in the co-moving frames.
template <class L>
SINEW_INLINE Triple<L> place_in_frame(const FrameDrift<typename L::Real>& drift, std::size_t block,
                                      int lane) {
  const auto i = static_cast<std::ptrdiff_t>(block) * Traits<typename L::Real>::block + lane;
  const Place<L> here = load_place<L>(drift.state.x, i);
  return by_comoving_frame<L>(
      drift.comoving_frames, block,
      lane, [&](const FrameNow<typename L::Real>& frame) __attribute__((always_inline)) {
        return into_frame<L>(frame, from_center<L>(frame, here));
      });
}

template <class L>
void remember_blocks(const FrameDrift<typename L::Real>& drift, std::size_t begin,
                     std::size_t end) {
  constexpr int size = Traits<typename L::Real>::block;
  for (std::size_t block = begin; block < end; ++block)
    for (int lane = 0; lane < size; lane += L::width) {
      const Triple<L> at = place_in_frame<L>(drift, block, lane);
      typename L::Real one[L::width];
      const typename L::V axes[3] = {at.x, at.y, at.z};
      for (int axis = 0; axis < 3; ++axis) {
        L::store(one, axes[axis]);
        for (int k = 0; k < L::width; ++k)
          drift.reference[axis][block * size + lane + k] = static_cast<float>(one[k]);
      }
    }
}

template <class L>
SINEW_INLINE typename L::V load_floats(const float* p) {
  typename L::Real one[L::width];
  for (int k = 0; k < L::width; ++k) one[k] = static_cast<typename L::Real>(p[k]);
  return L::load(one);
}

template <class L>
typename L::Real largest_displacement(const FrameDrift<typename L::Real>& drift, std::size_t begin,
                                      std::size_t end) {
  constexpr int size = Traits<typename L::Real>::block;
  typename L::V most = L::all(0);
  for (std::size_t block = begin; block < end; ++block)
    for (int lane = 0; lane < size; lane += L::width) {
      const std::size_t i = block * size + lane;
      const Triple<L> was{load_floats<L>(drift.reference[0] + i),
                          load_floats<L>(drift.reference[1] + i),
                          load_floats<L>(drift.reference[2] + i)};
      const Triple<L> moved = place_in_frame<L>(drift, block, lane) - was;
      most = L::larger(dot<L>(moved, moved), most);
    }
  typename L::Real one[L::width], largest = 0;
  L::store(one, most);
  for (int k = 0; k < L::width; ++k) largest = one[k] > largest ? one[k] : largest;
  return largest;
}

}  // namespace sinew::kernel

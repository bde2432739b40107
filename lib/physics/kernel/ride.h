// SPDX-License-Identifier: GPL-3.0-or-later
// How far particles have moved in the frames that carry them.
#pragma once

#include "physics/kernel/parts.h"

namespace sinew::kernel {

/// Places in the frames that carry them.
template <class L>
SINEW_INLINE Triple<L> ridden(const Ride<typename L::Real>& ride, std::size_t block, int lane) {
  const auto i = static_cast<std::ptrdiff_t>(block) * Traits<typename L::Real>::block + lane;
  const Place<L> here = load_place<L>(ride.state.x, i);
  return by_carrier<L>(
      ride.carriers, block,
      lane, [&](const FrameNow<typename L::Real>& frame) __attribute__((always_inline)) {
        return into_frame<L>(frame, from_centre<L>(frame, here));
      });
}

template <class L>
void remember_blocks(const Ride<typename L::Real>& ride, std::size_t begin, std::size_t end) {
  constexpr int size = Traits<typename L::Real>::block;
  for (std::size_t block = begin; block < end; ++block)
    for (int lane = 0; lane < size; lane += L::width) {
      const Triple<L> at = ridden<L>(ride, block, lane);
      typename L::Real one[L::width];
      const typename L::V axes[3] = {at.x, at.y, at.z};
      for (int axis = 0; axis < 3; ++axis) {
        L::store(one, axes[axis]);
        for (int k = 0; k < L::width; ++k)
          ride.reference[axis][block * size + lane + k] = static_cast<float>(one[k]);
      }
    }
}

template <class L>
SINEW_INLINE typename L::V widened(const float* p) {
  typename L::Real one[L::width];
  for (int k = 0; k < L::width; ++k) one[k] = static_cast<typename L::Real>(p[k]);
  return L::load(one);
}

template <class L>
typename L::Real largest_displacement(const Ride<typename L::Real>& ride, std::size_t begin,
                                      std::size_t end) {
  constexpr int size = Traits<typename L::Real>::block;
  typename L::V most = L::all(0);
  for (std::size_t block = begin; block < end; ++block)
    for (int lane = 0; lane < size; lane += L::width) {
      const std::size_t i = block * size + lane;
      const Triple<L> was{widened<L>(ride.reference[0] + i), widened<L>(ride.reference[1] + i),
                          widened<L>(ride.reference[2] + i)};
      const Triple<L> moved = ridden<L>(ride, block, lane) - was;
      most = L::larger(dot<L>(moved, moved), most);
    }
  typename L::Real one[L::width], largest = 0;
  L::store(one, most);
  for (int k = 0; k < L::width; ++k) largest = one[k] > largest ? one[k] : largest;
  return largest;
}

}  // namespace sinew::kernel

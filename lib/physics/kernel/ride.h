// SPDX-License-Identifier: GPL-3.0-or-later
// How far particles have moved in the frame of the bone that leads them.
#pragma once

#include "physics/kernel/parts.h"

namespace sinew::kernel {

/// Places in the frames of the leading bones.
template <class L>
SINEW_INLINE Triple<L> ridden(const Ride<typename L::Real>& ride, std::size_t block, int lane) {
  const auto i = static_cast<std::ptrdiff_t>(block) * Traits<typename L::Real>::block + lane;
  const Place<L> here = load_place<L>(ride.state.x, i);
  const typename L::V unit = L::all(ride.unit);
  typename L::V unled = L::all(1);
  Triple<L> sum = none<L>();
  for (std::uint32_t s = ride.holds.first[block]; s != ride.holds.first[block + 1]; ++s) {
    const Slot slot = ride.holds.slots[s];
    const auto& bone = ride.holds.bones[slot.bone];
    const typename L::V leads = shares_of<L>(ride.holds, slot, lane).lead;
    sum = sum + leads * into_frame<L>(bone, from_centre<L>(bone, here, unit));
    unled = unled - leads;
  }
  if (!L::any(L::less(L::all(0), unled))) return sum;
  return sum + unled * into_frame<L>(*ride.world, from_centre<L>(*ride.world, here, unit));
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

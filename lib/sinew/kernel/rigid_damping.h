// SPDX-License-Identifier: GPL-3.0-or-later
// Damping relative to a mean of affine motions.
#pragma once

#include <sinew/kernel/vectors.h>

namespace sinew::kernel {

template <class L>
struct Braking {
  Triple<L> force = none<L>();
  typename L::V power = L::all(0);     ///< power from all that it is relative to
  typename L::V of_bones = L::all(0);  ///< the bones' part of it
};

template <class L>
SINEW_INLINE Triple<L> velocity_of(const AffineMotion<typename L::Real>& motion,
                                   const Place<L>& here) {
  const Place<L> center{L::all_coord(motion.center[0]), L::all_coord(motion.center[1]),
                        L::all_coord(motion.center[2])};
  const Triple<L> arm = offset<L>(here, center);
  const auto* g = motion.gradient;
  return all<L>(motion.velocity) +
         Triple<L>{dot<L>(all<L>(g), arm), dot<L>(all<L>(g + 3), arm), dot<L>(all<L>(g + 6), arm)};
}

template <class L>
SINEW_INLINE Braking<L> braking(const Step<typename L::Real>& step, std::size_t block, int lane,
                                const Place<L>& here, const Triple<L>& velocity) {
  constexpr int size = Traits<typename L::Real>::block;
  const auto& rigid = step.rigid;
  const std::uint32_t begin = rigid.first[block], end = rigid.first[block + 1];
  Triple<L> all_of_them = none<L>(), of_bones = none<L>();
  for (std::uint32_t s = begin; s != end; ++s) {
    const Slot& slot = rigid.slots[s];
    const auto& motion = rigid.motions[slot.bone];
    Triple<L> one = velocity_of<L>(motion, here);
    if (slot.weights >= 0)
      one = L::load(rigid.weights + static_cast<std::ptrdiff_t>(slot.weights) * size + lane) * one;
    all_of_them = all_of_them + one;
    if (motion.of_bones != 0) of_bones = of_bones + one;
  }
  typename L::V rate = L::all(rigid.rate);
  if (step.mass != nullptr)
    rate = rate * L::load(step.mass + static_cast<std::ptrdiff_t>(block) * size + lane);
  Braking<L> found;
  found.force = rate * (all_of_them - velocity);
  found.power = dot<L>(found.force, all_of_them);
  found.of_bones = dot<L>(found.force, of_bones);
  return found;
}

}  // namespace sinew::kernel

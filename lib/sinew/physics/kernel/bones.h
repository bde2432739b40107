// SPDX-License-Identifier: GPL-3.0-or-later
// Forces of the bones on a vector of particles; ../bone_force.h gives them for one particle.
#pragma once

#include <sinew/physics/kernel/parts.h>

namespace sinew::kernel {

template <class L>
struct BoneSums {
  Triple<L> spring = none<L>(), damping = none<L>();
  typename L::V power = L::all(0);          ///< from the bones
  typename L::V damping_power = L::all(0);  ///< the damping's part of it
  typename L::V energy = L::all(0);         ///< in the springs; only where requested
  /// Velocity of the leading bone at this place; the particle's own without one.
  Triple<L> carried = none<L>();
};

/// A particle's coordinates in the frame of one bone.
template <class L>
struct Held {
  typename L::V foot, along, across_1, across_2, distance;
};

template <class L>
SINEW_INLINE Held<L> held_by(const Holds<typename L::Real>& holds, std::ptrdiff_t slot, int lane) {
  constexpr int block = Traits<typename L::Real>::block;
  const auto* fields = holds.held + slot * held_fields * block + lane;
  return {L::load(fields + foot * block), L::load(fields + along * block),
          L::load(fields + across_1 * block), L::load(fields + across_2 * block),
          L::load(fields + distance * block)};
}

template <class L>
struct Pull {
  Triple<L> force;  ///< in the bone's frame
  typename L::V energy;
};

/// Keeps the distance from the foot.
template <class L, bool energy>
SINEW_INLINE Pull<L> radial_pull(typename L::V k, const Triple<L>& at, const Held<L>& held) {
  const Triple<L> out{at.x - held.foot, at.y, at.z};
  const typename L::V d2 = dot<L>(out, out), d = L::root(d2);
  const typename L::V stretch =
      L::pick(L::less(L::all(0), d), L::all(1) - held.distance / d, L::all(0));
  Pull<L> pull{(L::all(0) - k * stretch) * out, L::all(0)};
  if constexpr (energy) {
    const typename L::V longer = d - held.distance;
    pull.energy = k * (longer * longer);
  }
  return pull;
}

/// The taper of the twist near the axis, s = 2 |rho| / rho0 < 1, in lanes that close to it: `share`
/// is s, and `inward` the force along rho, by rho^2, that the slope of s adds.
template <class L>
SINEW_INLINE void taper(typename L::V rho2, typename L::V rho02, typename L::V drive_alpha,
                        typename L::V& share, typename L::V& inward) {
  const auto tight = L::less(L::all(4) * rho2, rho02);
  if (!L::any(tight)) return;
  const typename L::V s2 = L::all(4) * rho2 / rho02;
  share = L::pick(tight, L::root(s2), L::all(1));
  inward = L::keep(tight, drive_alpha * s2 / rho2);
}

/// Rotates the particle with the bone: U = k rho0^2 alpha^2 s^2 / 2.
template <class L, bool energy>
SINEW_INLINE Pull<L> twist_pull(typename L::V k, const Triple<L>& at, const Held<L>& held) {
  using V = typename L::V;
  const V rho2 = L::fused(at.y, at.y, at.z * at.z);
  const V rho02 = L::fused(held.across_1, held.across_1, held.across_2 * held.across_2);
  const V alpha = arctangent<L>(L::less_fused(held.across_2, at.y, held.across_1 * at.z),
                                L::fused(held.across_1, at.y, held.across_2 * at.z));
  const V drive = k * rho02 * alpha;
  V inward = L::all(0), share = L::all(1);
  taper<L>(rho2, rho02, drive * alpha, share, inward);
  const auto turns = L::less(L::all(0), rho2 * rho02);
  const V per_rho2 = L::all(1) / rho2;
  const V around = L::keep(turns, share * share * drive * per_rho2), in = L::keep(turns, inward);
  Pull<L> pull{{L::all(0), L::less_fused(in, at.y, around * at.z),
                L::less_fused(in, at.z, (L::all(0) - around) * at.y)},
               L::all(0)};
  if constexpr (energy) pull.energy = L::keep(turns, drive * alpha * (share * share));
  return pull;
}

/// Resists sliding along the bone.
template <class L, bool energy>
SINEW_INLINE Pull<L> axial_pull(typename L::V k, const Triple<L>& at, const Held<L>& held) {
  const typename L::V slide = at.x - held.along;
  Pull<L> pull{{L::all(0) - k * slide, L::all(0), L::all(0)}, L::all(0)};
  if constexpr (energy) pull.energy = k * (slide * slide);
  return pull;
}

/// The forces of one bone with a weight of 1.
template <class L, bool energy>
SINEW_INLINE BoneSums<L> whole_pull(const BoneNow<typename L::Real>& bone, const Held<L>& held,
                                    const Place<L>& here, const Triple<L>& velocity) {
  const Triple<L> arm = from_center<L>(bone.frame, here);
  const Triple<L> at = into_frame<L>(bone.frame, arm);
  const Pull<L> radial = radial_pull<L, energy>(L::all(bone.radial), at, held);
  const Pull<L> twist = twist_pull<L, energy>(L::all(bone.twist), at, held);
  const Pull<L> axial = axial_pull<L, energy>(L::all(bone.axial), at, held);
  BoneSums<L> pull;
  pull.carried = carried_by<L>(bone.frame, arm);
  pull.spring =
      from_frame<L>(bone.frame, {radial.force.x + axial.force.x, radial.force.y + twist.force.y,
                                 radial.force.z + twist.force.z});
  pull.damping = L::all(bone.damping) * (pull.carried - velocity);
  pull.damping_power = dot<L>(pull.damping, pull.carried);
  pull.power = pull.damping_power + dot<L>(pull.spring, pull.carried);
  if constexpr (energy)
    pull.energy =
        (radial.energy + twist.energy + axial.energy) * L::all(static_cast<typename L::Real>(0.5));
  return pull;
}

template <class L>
SINEW_INLINE void add(const BoneSums<L>& pull, const Shares<L>& shares, BoneSums<L>& sums) {
  sums.spring = fused<L>(shares.weight, pull.spring, sums.spring);
  sums.damping = fused<L>(shares.weight, pull.damping, sums.damping);
  sums.power = L::fused(shares.weight, pull.power, sums.power);
  sums.damping_power = L::fused(shares.weight, pull.damping_power, sums.damping_power);
  sums.energy = L::fused(shares.weight, pull.energy, sums.energy);
  sums.carried = fused<L>(shares.lead, pull.carried, sums.carried);
}

/// All bones of a vector. A single bone, by far the most frequent case, needs no weights.
template <class L, bool energy>
SINEW_INLINE BoneSums<L> bone_sums(const Step<typename L::Real>& step, std::size_t block, int lane,
                                   const Place<L>& here, const Triple<L>& velocity) {
  const auto& holds = step.holds;
  const std::uint32_t begin = holds.first[block], end = holds.first[block + 1];
  const auto pull_of = [&](std::uint32_t s) __attribute__((always_inline)) {
    return whole_pull<L, energy>(holds.bones[holds.slots[s].bone], held_by<L>(holds, s, lane), here,
                                 velocity);
  };
  if (end - begin == 1 && holds.slots[begin].shares < 0) [[likely]]
    return pull_of(begin);
  BoneSums<L> sums;
  typename L::V led = L::all(0);
  for (std::uint32_t s = begin; s != end; ++s) {
    const Shares<L> shares = shares_of<L>(holds, holds.slots[s], lane);
    add<L>(pull_of(s), shares, sums);
    led = led + shares.lead;
  }
  sums.carried = fused<L>(L::all(1) - led, velocity, sums.carried);
  return sums;
}

}  // namespace sinew::kernel

// SPDX-License-Identifier: GPL-3.0-or-later
// What the bones do to a vector of particles: bone_force.h says it particle by particle.
#pragma once

#include "physics/kernel/arctangent.h"
#include "physics/kernel/parts.h"

namespace sinew::kernel {

template <class L>
struct BoneSums {
  Triple<L> spring = none<L>(), damping = none<L>();
  typename L::V power = L::all(0);          ///< that the bones put in
  typename L::V damping_power = L::all(0);  ///< the damping's part of it
  typename L::V energy = L::all(0);         ///< in the springs; only when asked for
  Triple<L> carried = none<L>();            ///< velocity of the leading bone here
};

/// A particle's numbers in the frame of one bone.
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

/// The taper of the twist near the axis, s = 2 |rho| / rho0 < 1, in the lanes that are so near;
/// `drive` becomes k rho0^2 alpha s and `inward` the pull along rho that the taper's slope adds.
template <class L>
SINEW_INLINE void taper(typename L::V rho2, typename L::V rho02, typename L::V alpha,
                        typename L::V& drive, typename L::V& inward, typename L::V& share) {
  const auto tight = L::less(L::all(4) * rho2, rho02);
  if (!L::any(tight)) return;
  const typename L::V s = L::root(L::all(4) * rho2 / rho02);
  share = L::pick(tight, s, L::all(1));
  drive = drive * share;
  // alpha (2 / rho0) (rho / |rho|) = alpha s rho / rho^2
  inward = L::keep(tight, drive * alpha * share);
}

/// Turns with the bone: U = k rho0^2 alpha^2 s^2 / 2.
template <class L, bool energy>
SINEW_INLINE Pull<L> twist_pull(typename L::V k, const Triple<L>& at, const Held<L>& held) {
  using V = typename L::V;
  const V rho2 = at.y * at.y + at.z * at.z;
  const V rho02 = held.across_1 * held.across_1 + held.across_2 * held.across_2;
  const V alpha = arctangent<L>(held.across_1 * at.z - held.across_2 * at.y,
                                held.across_1 * at.y + held.across_2 * at.z);
  V drive = k * rho02 * alpha, inward = L::all(0), share = L::all(1);
  taper<L>(rho2, rho02, alpha, drive, inward, share);
  const auto turns = L::both(L::less(L::all(0), rho2), L::less(L::all(0), rho02));
  const V around = L::keep(turns, drive / rho2), in = L::keep(turns, inward / rho2);
  Pull<L> pull{{L::all(0), around * at.z - in * at.y, L::all(0) - around * at.y - in * at.z},
               L::all(0)};
  if constexpr (energy) pull.energy = L::keep(turns, k * rho02 * (alpha * alpha) * (share * share));
  return pull;
}

/// Against sliding along the bone.
template <class L, bool energy>
SINEW_INLINE Pull<L> axial_pull(typename L::V k, const Triple<L>& at, const Held<L>& held) {
  const typename L::V slide = at.x - held.along;
  Pull<L> pull{{L::all(0) - k * slide, L::all(0), L::all(0)}, L::all(0)};
  if constexpr (energy) pull.energy = k * (slide * slide);
  return pull;
}

/// Adds what one bone does.
template <class L, bool energy>
SINEW_INLINE void add_bone(const BoneNow<typename L::Real>& bone, const Held<L>& held,
                           const Shares<L>& shares, const Triple<L>& arm, const Triple<L>& velocity,
                           BoneSums<L>& sums) {
  using V = typename L::V;
  const Triple<L> at = into_frame<L>(bone, arm);
  const Pull<L> radial = radial_pull<L, energy>(L::all(bone.radial), at, held);
  const Pull<L> twist = twist_pull<L, energy>(L::all(bone.twist), at, held);
  const Pull<L> axial = axial_pull<L, energy>(L::all(bone.axial), at, held);
  const Triple<L> local = radial.force + twist.force + axial.force;
  const Triple<L> spring = shares.weight * from_frame<L>(bone, local);

  const Triple<L> carried = all<L>(bone.velocity) + cross<L>(all<L>(bone.spin), arm);
  const V rate = shares.weight * L::all(bone.damping);
  const Triple<L> damping = rate * (carried - velocity);
  sums.spring = sums.spring + spring;
  sums.damping = sums.damping + damping;
  sums.power = sums.power + dot<L>(spring + damping, carried);
  sums.damping_power = sums.damping_power + dot<L>(damping, carried);
  sums.carried = sums.carried + shares.lead * carried;
  if constexpr (energy)
    sums.energy = sums.energy + shares.weight * (radial.energy + twist.energy + axial.energy) *
                                    L::all(static_cast<typename L::Real>(0.5));
}

template <class L, bool energy>
SINEW_INLINE BoneSums<L> bone_sums(const Step<typename L::Real>& step, std::size_t block, int lane,
                                   const Place<L>& here, const Triple<L>& velocity) {
  const auto& holds = step.holds;
  BoneSums<L> sums;
  for (std::uint32_t s = holds.first[block]; s != holds.first[block + 1]; ++s) {
    const Slot slot = holds.slots[s];
    const auto& bone = holds.bones[slot.bone];
    const Triple<L> arm = from_centre<L>(bone, here, L::all(step.unit));
    add_bone<L, energy>(bone, held_by<L>(holds, s, lane), shares_of<L>(holds, slot, lane), arm,
                        velocity, sums);
  }
  return sums;
}

}  // namespace sinew::kernel

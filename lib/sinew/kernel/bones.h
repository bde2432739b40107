// SPDX-License-Identifier: GPL-3.0-or-later
// Forces of the bones on a vector of particles; body/bone_force.h gives them for one particle.
#pragma once

#include <numbers>

#include <sinew/kernel/vectors.h>

namespace sinew::kernel {

template <class L>
struct BoneSums {
  Triple<L> spring = none<L>(), damping = none<L>();
  typename L::V power = L::all(0);          ///< power from the bones
  typename L::V damping_power = L::all(0);  ///< the damping's part of it
  typename L::V energy = L::all(0);         ///< in the springs; only where requested
  /// Velocity of the leading bone at this place; the particle's own without one.
  Triple<L> carried = none<L>();
};

/// A particle's coordinates in the frame of one bone.
template <class L>
struct Attachment {
  typename L::V foot, along, across_1, across_2, distance;
};

template <class L>
SINEW_INLINE Attachment<L> attachment_of(const Bindings<typename L::Real>& bindings,
                                         std::ptrdiff_t slot, int lane) {
  constexpr int block = Traits<typename L::Real>::block;
  const auto* fields = bindings.attachments + slot * attachment_fields * block + lane;
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
SINEW_INLINE Pull<L> radial_pull(typename L::V k, const Triple<L>& at,
                                 const Attachment<L>& attachment) {
  const Triple<L> out{at.x - attachment.foot, at.y, at.z};
  const typename L::V d2 = dot<L>(out, out), d = L::root(d2);
  const typename L::V stretch =
      L::pick(L::less(L::all(0), d), L::all(1) - attachment.distance / d, L::all(0));
  Pull<L> pull{(L::all(0) - k * stretch) * out, L::all(0)};
  if constexpr (energy) {
    const typename L::V longer = d - attachment.distance;
    pull.energy = k * (longer * longer);
  }
  return pull;
}

/// The taper of the twist near the axis, s = 2 |rho| / rho0 < 1, in lanes that close to it:
/// `narrowing` is s, and `inward` the force along rho, by rho^2, that the slope of s adds; `twice`:
/// 2 k rho0^2 G.
template <class L>
SINEW_INLINE void taper(typename L::V rho2, typename L::V rho02, typename L::V twice,
                        typename L::V& narrowing, typename L::V& inward) {
  const auto tight = L::less(L::all(4) * rho2, rho02);
  if (!L::any(tight)) return;
  const typename L::V s2 = L::all(4) * rho2 / rho02;
  narrowing = L::pick(tight, L::root(s2), L::all(1));
  inward = L::keep(tight, twice * s2 / rho2);
}

/// Sets G' and 2 G of TwistEnergy in lanes beyond 120 degrees.
template <class L>
SINEW_INLINE void fade_twist(typename L::V alpha, typename L::V& slope, typename L::V& twice) {
  using V = typename L::V;
  using Real = typename L::Real;
  constexpr Real linear = static_cast<Real>(2 * std::numbers::pi / 3), fading = linear / 2;
  const V angle = L::size(alpha);
  const auto beyond = L::less(L::all(linear), angle);
  if (!L::any(beyond)) return;
  const V t = L::smaller((angle - L::all(linear)) * L::all(1 / fading), L::all(1)), t2 = t * t;
  const V falling = L::all(linear) * (L::all(1) - t2 * (L::all(3) - t - t));
  const V signed_slope = L::pick(L::less(L::all(0), alpha), falling, L::all(0) - falling);
  const V rise = t - t2 * t + t2 * t2 * L::all(static_cast<Real>(0.5));
  slope = L::pick(beyond, signed_slope, slope);
  twice = L::pick(beyond, L::all(linear * linear) + L::all(2 * linear * fading) * rise, twice);
}

/// Rotates the particle with the bone: U = k rho0^2 s^2 G(alpha).
template <class L, bool energy>
SINEW_INLINE Pull<L> twist_pull(typename L::V k, const Triple<L>& at,
                                const Attachment<L>& attachment) {
  using V = typename L::V;
  const V rho2 = L::fused(at.y, at.y, at.z * at.z);
  const V rho02 =
      L::fused(attachment.across_1, attachment.across_1, attachment.across_2 * attachment.across_2);
  const V alpha =
      arctangent<L>(L::less_fused(attachment.across_2, at.y, attachment.across_1 * at.z),
                    L::fused(attachment.across_1, at.y, attachment.across_2 * at.z));
  V slope = alpha, twice = alpha * alpha;
  fade_twist<L>(alpha, slope, twice);
  const V scale = k * rho02, drive = scale * slope;
  V inward = L::all(0), narrowing = L::all(1);
  taper<L>(rho2, rho02, scale * twice, narrowing, inward);
  const auto turns = L::less(L::all(0), rho2 * rho02);
  const V per_rho2 = L::all(1) / rho2;
  const V around = L::keep(turns, narrowing * narrowing * drive * per_rho2),
          in = L::keep(turns, inward);
  Pull<L> pull{{L::all(0), L::less_fused(in, at.y, around * at.z),
                L::less_fused(in, at.z, (L::all(0) - around) * at.y)},
               L::all(0)};
  if constexpr (energy) pull.energy = L::keep(turns, scale * twice * (narrowing * narrowing));
  return pull;
}

/// Turns the particle about the bone, whatever it does: nothing is stored.
template <class L>
SINEW_INLINE Pull<L> open_loop_pull(typename L::V k, const Triple<L>& at) {
  return {{L::all(0), L::all(0) - k * at.z, k * at.y}, L::all(0)};
}

/// Keeps the particle at its place.
template <class L, bool energy>
SINEW_INLINE Pull<L> anchor_pull(typename L::V k, const Triple<L>& at,
                                 const Attachment<L>& attachment) {
  const Triple<L> away{at.x - attachment.along, at.y - attachment.across_1,
                       at.z - attachment.across_2};
  Pull<L> pull{(L::all(0) - k) * away, L::all(0)};
  if constexpr (energy) pull.energy = k * dot<L>(away, away);
  return pull;
}

/// Resists sliding along the bone.
template <class L, bool energy>
SINEW_INLINE Pull<L> axial_pull(typename L::V k, const Triple<L>& at,
                                const Attachment<L>& attachment) {
  const typename L::V slide = at.x - attachment.along;
  Pull<L> pull{{L::all(0) - k * slide, L::all(0), L::all(0)}, L::all(0)};
  if constexpr (energy) pull.energy = k * (slide * slide);
  return pull;
}

/// The springs about a bone's axis, in its frame; `slides`: the force that each spring takes from
/// the bone as it grows, times where it holds on along the bone.
template <class L, bool energy>
SINEW_INLINE Pull<L> spring_pull(const BoneNow<typename L::Real>& bone, const Triple<L>& at,
                                 const Attachment<L>& attachment, const Attachment<L>& at_rest,
                                 typename L::V& slides) {
  if (bone.pulls == anchor) [[unlikely]] {
    const Pull<L> pull = anchor_pull<L, energy>(L::all(bone.radial), at, attachment);
    slides = pull.force.x * (at_rest.along + L::all(bone.center));
    return pull;
  }
  const Pull<L> radial = radial_pull<L, energy>(L::all(bone.radial), at, attachment);
  const Pull<L> axial = axial_pull<L, energy>(L::all(bone.axial), at, attachment);
  Pull<L> twist;
  if (bone.pulls == open_loop) [[unlikely]]
    twist = open_loop_pull<L>(L::all(bone.turning), at);
  else
    twist = twist_pull<L, energy>(L::all(bone.twist), at, attachment);
  slides = radial.force.x * (at_rest.foot + L::all(bone.center)) +
           axial.force.x * (at_rest.along + L::all(bone.center));
  return {{radial.force.x + axial.force.x, radial.force.y + twist.force.y,
           radial.force.z + twist.force.z},
          radial.energy + twist.energy + axial.energy};
}

template <class L>
struct YieldingPull {
  Pull<L> pull;
  typename L::V slides;
};

/// Springs that yield: body/bone_force.h has the form. A function of its own, which takes values:
/// few bones have them, and those of all others stay in registers.
template <class L>
[[gnu::noinline]] YieldingPull<L> yielding_pull(const BoneNow<typename L::Real>& bone, Triple<L> at,
                                                Attachment<L> attachment, Attachment<L> at_rest) {
  YieldingPull<L> yielding;
  auto& [pull, slides] = yielding;
  pull = spring_pull<L, true>(bone, at, attachment, at_rest, slides);
  const typename L::V limit = L::all(bone.yield);
  const auto beyond = L::less(limit, pull.energy);
  if (!L::any(beyond)) return yielding;
  const typename L::V slope = L::pick(beyond, L::root(limit / pull.energy), L::all(1));
  pull.force = slope * pull.force;
  slides = slope * slides;
  const typename L::V grown = (slope + slope) * pull.energy - limit;
  pull.energy = L::pick(beyond, grown, pull.energy);
  return yielding;
}

/// Velocity of the bone's point at `at` in its frame, beyond that of a rigid bone.
template <class L>
SINEW_INLINE Triple<L> stretching(const BoneNow<typename L::Real>& bone, typename L::V along) {
  const typename L::Real rate = bone.stretch_rate / bone.stretch;
  return (L::all(rate) * (along + L::all(bone.stretch * bone.center))) * all<L>(bone.frame.axes);
}

/// A damped bone brings its own velocity at the particle, or at its place for an anchor.
template <class L>
SINEW_INLINE Triple<L> braked_to(const BoneNow<typename L::Real>& bone,
                                 const Attachment<L>& attachment, const Triple<L>& carried) {
  if (bone.pulls != anchor) return carried;
  const Triple<L> arm =
      from_frame<L>(bone.frame, {attachment.along, attachment.across_1, attachment.across_2});
  Triple<L> velocity = carried_by<L>(bone.frame, arm);
  if (bone.stretch_rate != 0) velocity = velocity + stretching<L>(bone, attachment.along);
  return velocity;
}

/// The forces of one bone with a weight of 1.
template <class L, bool energy>
SINEW_INLINE BoneSums<L> whole_pull(const BoneNow<typename L::Real>& bone,
                                    const Attachment<L>& at_rest, const Place<L>& here,
                                    const Triple<L>& velocity) {
  const Triple<L> arm = from_center<L>(bone.frame, here);
  const Triple<L> at = into_frame<L>(bone.frame, arm);
  Attachment<L> attachment = at_rest;
  if (bone.stretch != 1) {
    attachment.foot = L::all(bone.stretch) * attachment.foot;
    attachment.along = L::all(bone.stretch) * attachment.along;
  }
  typename L::V slides;
  Pull<L> springs;
  if (bone.yield > 0) [[unlikely]] {
    const YieldingPull<L> yielding = yielding_pull<L>(bone, at, attachment, at_rest);
    springs = yielding.pull, slides = yielding.slides;
  } else {
    springs = spring_pull<L, energy>(bone, at, attachment, at_rest, slides);
  }
  BoneSums<L> pull;
  pull.spring = from_frame<L>(bone.frame, springs.force);
  pull.carried = carried_by<L>(bone.frame, arm);
  // Springs are fixed at the foot at rest, not at the particle.
  typename L::V spring_power = dot<L>(pull.spring, pull.carried);
  if (bone.stretch_rate != 0) {
    spring_power = L::fused(L::all(bone.stretch_rate), slides, spring_power);
    pull.carried = pull.carried + stretching<L>(bone, at.x);
  }
  pull.damping = L::all(bone.damping) * (braked_to<L>(bone, attachment, pull.carried) - velocity);
  pull.damping_power = dot<L>(pull.damping, pull.carried);
  pull.power = pull.damping_power + spring_power;
  if constexpr (energy) pull.energy = springs.energy * L::all(static_cast<typename L::Real>(0.5));
  return pull;
}

template <class L>
SINEW_INLINE void add(const BoneSums<L>& pull, const Weights<L>& weights, BoneSums<L>& sums) {
  sums.spring = fused<L>(weights.weight, pull.spring, sums.spring);
  sums.damping = fused<L>(weights.weight, pull.damping, sums.damping);
  sums.power = L::fused(weights.weight, pull.power, sums.power);
  sums.damping_power = L::fused(weights.weight, pull.damping_power, sums.damping_power);
  sums.energy = L::fused(weights.weight, pull.energy, sums.energy);
  sums.carried = fused<L>(weights.lead, pull.carried, sums.carried);
}

/// All bones of a vector. A single bone, by far the most frequent case, needs no weights.
template <class L, bool energy>
SINEW_INLINE BoneSums<L> bone_sums(const Step<typename L::Real>& step, std::size_t block, int lane,
                                   const Place<L>& here, const Triple<L>& velocity) {
  const auto& bindings = step.bindings;
  const std::uint32_t begin = bindings.first[block], end = bindings.first[block + 1];
  const auto pull_of = [&](std::uint32_t s) __attribute__((always_inline)) {
    return whole_pull<L, energy>(bindings.bones[bindings.slots[s].bone],
                                 attachment_of<L>(bindings, s, lane), here, velocity);
  };
  if (end - begin == 1 && bindings.slots[begin].weights < 0) [[likely]]
    return pull_of(begin);
  BoneSums<L> sums;
  typename L::V led = L::all(0);
  for (std::uint32_t s = begin; s != end; ++s) {
    const Weights<L> weights = weights_of<L>(bindings, bindings.slots[s], lane);
    add<L>(pull_of(s), weights, sums);
    led = led + weights.lead;
  }
  sums.carried = fused<L>(L::all(1) - led, velocity, sums.carried);
  return sums;
}

}  // namespace sinew::kernel

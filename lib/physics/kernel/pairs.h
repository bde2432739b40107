// SPDX-License-Identifier: GPL-3.0-or-later
// What the partners of a vector of particles do to them: eq. 1, and what eq. 2 needs to know.
#pragma once

#include "physics/kernel/parts.h"

namespace sinew::kernel {

template <class L>
struct PairSums {
  Triple<L> force = none<L>();       ///< eq. 1
  Triple<L> velocities = none<L>();  ///< of the partners
  typename L::V count = L::all(0);
  typename L::V energy = L::all(0);  ///< half of each pair's; only when asked for
};

/// The law of eq. 1 in all lanes.
template <class L>
struct LawLanes {
  using V = typename L::V;
  V two_r, four_r2, a, b, b2, k1, k2;

  SINEW_INLINE explicit LawLanes(const Law<typename L::Real>& law)
      : two_r(L::all(law.two_r)),
        four_r2(L::all(law.four_r2)),
        a(L::all(law.a)),
        b(L::all(law.b)),
        b2(L::all(law.b2)),
        k1(L::all(law.k1)),
        k2(L::all(law.k2)) {}

  /// For d < b; each of the two terms is zero where the other acts. s = d^2.
  SINEW_INLINE V force(V d, V s) const {
    const V repulsion = k1 * L::larger(four_r2 - s, L::all(0));
    const V attraction = k2 * L::larger(d - a, L::all(0)) * (b - d);
    return repulsion - attraction;
  }

  SINEW_INLINE V potential(V d) const {
    const V far = L::larger(d, a), left = b - far, overlap = L::larger(two_r - d, L::all(0));
    const V deep = k2 * (left * left) * (far + far + b - L::all(3) * a) / L::all(6);
    return k1 * (overlap * overlap) * (two_r + two_r + d) / L::all(3) - deep;
  }
};

/// +1 or -1: two particles in one place part along x, the lower id to the left.
template <class L>
SINEW_INLINE typename L::V way_out(const std::int32_t* id, std::ptrdiff_t i, std::ptrdiff_t j) {
  typename L::Real way[L::width];
  for (int k = 0; k < L::width; ++k)
    way[k] = id[i + k] < id[j + k] ? typename L::Real(-1) : typename L::Real(1);
  return L::load(way);
}

/// The sums over the differences [begin, end). Without `careful` a particle in the very place of
/// its partner gives no number.
template <class L, bool energy, bool careful>
SINEW_INLINE PairSums<L> sum_pairs(const Step<typename L::Real>& step, const LawLanes<L>& law,
                                   std::ptrdiff_t i, const std::int32_t* begin,
                                   const std::int32_t* end, typename L::M& met) {
  using V = typename L::V;
  const V unit = L::all(step.unit);
  const Place<L> here = load_place<L>(step.before.x, i);
  PairSums<L> sums;
  V least = law.b2;
  for (const std::int32_t* difference = begin; difference != end; ++difference) {
    const std::ptrdiff_t j = i + *difference;
    Triple<L> apart = offset<L>(here, load_place<L>(step.before.x, j), unit);
    const V s = dot<L>(apart, apart);
    const auto near = L::less(s, law.b2);
    if (!L::any(near)) continue;
    const V d = L::root(s);
    V divisor = d;
    if constexpr (careful) {
      const auto together = L::at_most(s, L::all(0));
      apart.x = L::pick(together, way_out<L>(step.id, i, j), apart.x);
      divisor = L::pick(together, L::all(1), d);
    }
    const V pull = L::keep(near, law.force(d, s) / divisor);
    sums.force = sums.force + pull * apart;
    const Triple<L> other = load<L>(step.before.v, j);
    sums.velocities.x = L::add_where(near, sums.velocities.x, other.x);
    sums.velocities.y = L::add_where(near, sums.velocities.y, other.y);
    sums.velocities.z = L::add_where(near, sums.velocities.z, other.z);
    sums.count = L::add_where(near, sums.count, L::all(1));
    if constexpr (energy)
      sums.energy = L::add_where(near, sums.energy,
                                 L::all(static_cast<typename L::Real>(0.5)) * law.potential(d));
    least = L::smaller(least, s);
  }
  met = L::at_most(least, L::all(0));
  return sums;
}

template <class L, bool energy>
SINEW_INLINE PairSums<L> pair_sums(const Step<typename L::Real>& step, const LawLanes<L>& law,
                                   std::ptrdiff_t i, const std::int32_t* begin,
                                   const std::int32_t* end) {
  typename L::M met;
  const PairSums<L> sums = sum_pairs<L, energy, false>(step, law, i, begin, end, met);
  if (!L::any(met)) return sums;
  return sum_pairs<L, energy, true>(step, law, i, begin, end, met);
}

/// Eq. 2: towards the mean velocity of the partners.
template <class L>
SINEW_INLINE Triple<L> damping_of(const PairSums<L>& sums, typename L::V rate,
                                  const Triple<L>& velocity) {
  const auto some = L::less(L::all(0), rate * sums.count);
  const typename L::V share = L::all(1) / L::larger(sums.count, L::all(1));
  const Triple<L> drag = rate * (share * sums.velocities - velocity);
  return {L::keep(some, drag.x), L::keep(some, drag.y), L::keep(some, drag.z)};
}

}  // namespace sinew::kernel

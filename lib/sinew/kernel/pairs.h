// SPDX-License-Identifier: GPL-3.0-or-later
// Forces of the neighbors of a vector of particles: eq. 1, and the sums that eq. 2 needs.
#pragma once

#include <sinew/kernel/vectors.h>

namespace sinew::kernel {

template <class L>
struct PairSums {
  Triple<L> force = none<L>();  ///< eq. 1
  /// Velocities of the neighbors; pairwise: relative, times both inverse counts.
  Triple<L> velocities = none<L>();
  typename L::V count = L::all(0);
  typename L::V energy = L::all(0);  ///< half of each pair's; only where requested
};

/// 1 / d from the squared distance.
template <class L, class Real = typename L::Real>
class InverseLength;

/// Single precision: exact root and division.
template <class L>
class InverseLength<L, float> {
 public:
  using V = typename L::V;
  SINEW_INLINE explicit InverseLength(const Law<float>&) {}
  template <bool careful>
  SINEW_INLINE V of(V squared) const {
    return L::all(1) / L::root(squared);
  }
};

/// Double precision, in whose vectors root and division are slow. Nearly all pairs are between 1.5
/// and 2.83 radii; there 1 / d takes half the time as a minimax polynomial in s = d^2 with a
/// relative error of 1.4e-3, improved by the series of 1 / sqrt(1 - h) up to h^5: an error of 2 in
/// the last place, the same everywhere.
template <class L>
class InverseLength<L, double> {
 public:
  using V = typename L::V;

  SINEW_INLINE explicit InverseLength(const Law<double>& law)
      : least(L::all(2.25 * law.r * law.r)), most(L::all(8 * law.r * law.r)) {
    constexpr double coefficients[] = {1.199850214, -0.3655432081, 0.07144285003, -0.007049514311,
                                       0.0002723509958};
    double scale = 1 / law.r;
    for (int k = 0; k < 5; ++k) {
      seed_[k] = L::all(coefficients[k] * scale);
      scale /= law.r * law.r;
    }
  }

  /// `careful`: of all s; without it of those between `least` and `most`.
  template <bool careful>
  SINEW_INLINE V of(V s) const {
    const V inverse = of_usual(s);
    if constexpr (!careful) return inverse;
    if (!L::any(L::less(s, least)) && !L::any(L::less(most, s))) return inverse;
    const V exact = L::all(1) / L::root(s);
    return L::pick(L::less(s, least), exact, L::pick(L::less(most, s), exact, inverse));
  }

  V least, most;

 private:
  SINEW_INLINE V of_usual(V s) const {
    const V s2 = s * s;
    const V low = L::fused(seed_[1], s, seed_[0]);
    const V high = L::fused(seed_[4], s2, L::fused(seed_[3], s, seed_[2]));
    const V y = L::fused(s2, high, low);
    const V h = L::less_fused(s * y, y, L::all(1)), h2 = h * h;
    const V first = L::fused(L::all(3. / 8), h, L::all(1. / 2));
    const V last = L::fused(L::all(63. / 256), h2, L::fused(L::all(35. / 128), h, L::all(5. / 16)));
    return L::fused(y * h, L::fused(h2, last, first), y);
  }

  V seed_[5];
};

/// f / d of eq. 1 in all lanes, for d < b, from the squared distance.
template <class L, class Real = typename L::Real>
class PullLaw;

template <class L>
class PullLaw<L, float> {
 public:
  using V = typename L::V;

  SINEW_INLINE explicit PullLaw(const Law<float>& law)
      : k1_(L::all(law.k1 / law.r)),
        touching_(L::all(4 * law.k1 * law.r)),
        b_(L::all(law.b)),
        k2_(L::all(law.k2 / law.r)),
        k2_a_(L::all(-law.k2 / law.r * law.a)) {}

  /// One of the two terms is zero. `d` is exact; at 0 the result is not a number.
  template <bool careful>
  SINEW_INLINE V pull(V squared, V& d) const {
    d = L::root(squared);
    const V repulsion = L::larger(L::less_fused(k1_, squared, touching_), L::all(0));
    const V stretch = L::larger(L::fused(k2_, d, k2_a_), L::all(0));
    return L::less_fused(stretch, b_ - d, repulsion) / d;
  }
  /// Whether a vector's sums must be repeated with `careful`: after a distance of 0.
  SINEW_INLINE bool needs_care(V, V force) const { return !L::every(L::at_most(force, force)); }

 private:
  V k1_, touching_, b_, k2_, k2_a_;
};

/// Attraction, (d - a) (b - d) / d = a + b - (s + a b) / d, is written so that little depends on
/// 1 / d, for which the loop waits.
template <class L>
class PullLaw<L, double> {
 public:
  using V = typename L::V;

  SINEW_INLINE explicit PullLaw(const Law<double>& law)
      : inverse_(law),
        usual_(law.b * law.b <= 8 * law.r * law.r ? inverse_.least : L::all(1e300)),
        a2_(L::all(law.a * law.a)),
        k1_(L::all(law.k1 / law.r)),
        touching_(L::all(4 * law.k1 * law.r)),
        k2_(L::all(law.k2 / law.r)),
        k2_ab_(L::all(law.k2 / law.r * law.a * law.b)),
        k2_a_b_(L::all(-law.k2 / law.r * (law.a + law.b))) {}

  template <bool careful>
  SINEW_INLINE V pull(V s, V& d) const {
    const V inverse = inverse_.template of<careful>(s);
    d = s * inverse;
    const auto attracted = L::at_most(a2_, s);
    const V repulsion = L::larger(L::less_fused(k1_, s, touching_), L::all(0));
    const V factor = L::pick(attracted, L::fused(k2_, s, k2_ab_), repulsion);
    return L::fused(factor, inverse, L::keep(attracted, k2_a_b_));
  }
  SINEW_INLINE bool needs_care(V least, V) const { return L::any(L::less(least, usual_)); }

 private:
  InverseLength<L> inverse_;
  V usual_, a2_, k1_, touching_, k2_, k2_ab_, k2_a_b_;
};

/// The potential of eq. 1 at d < b.
template <class L>
SINEW_INLINE typename L::V potential(const Law<typename L::Real>& law, typename L::V d) {
  using V = typename L::V;
  const V a = L::all(law.a), b = L::all(law.b), r = L::all(law.r);
  const V far = L::larger(d, a), left = b - far, overlap = L::larger(r + r - d, L::all(0));
  const V deep = L::all(law.k2) * (left * left) * (far + far + b - L::all(3) * a) / (L::all(6) * r);
  return L::all(law.k1) * (overlap * overlap) * (L::all(4) * r + d) / (L::all(3) * r) - deep;
}

/// +1 or -1: two coincident particles separate along x, the lower id to the left.
template <class L>
SINEW_INLINE typename L::V separation_sign(const std::int32_t* id, std::ptrdiff_t i,
                                           std::ptrdiff_t j) {
  typename L::Real sign[L::width];
  for (int k = 0; k < L::width; ++k)
    sign[k] = id[i + k] < id[j + k] ? typename L::Real(-1) : typename L::Real(1);
  return L::load(sign);
}

/// At d = 0 a force has a magnitude, `push`, and no direction.
template <class L>
SINEW_INLINE void part(const Step<typename L::Real>& step, std::ptrdiff_t i, std::ptrdiff_t j,
                       typename L::V squared, typename L::V push, typename L::V& pull,
                       typename L::V& d, typename L::V& apart_x) {
  const auto together = L::at_most(squared, L::all(0));
  if (!L::any(together)) return;
  pull = L::pick(together, push, pull);
  d = L::pick(together, L::all(0), d);
  apart_x = L::pick(together, separation_sign<L>(step.id, i, j), apart_x);
}

/// Eq. 1 between particles at the same place.
template <class L>
SINEW_INLINE typename L::V push_of(const Law<typename L::Real>& law) {
  return L::all(4 * law.k1 * law.r);
}

/// What a pass over the pairs sums up: the forces and what a form of damping needs, or the number
/// of neighbors alone.
enum Pass { forces_to_the_mean, forces_pairwise, counts };

/// Sums of a vector, in registers.
template <class L, Pass pass, bool energy>
struct Adder {
  using V = typename L::V;
  V fx = L::all(0), fy = fx, fz = fx, su = fx, sv = fx, sw = fx, count = fx, stored = fx;

  /// What `pull` and `apart` are of particle j to `near` lanes of the vector at i.
  template <class Energy>
  SINEW_INLINE void add(const Step<typename L::Real>& step, std::ptrdiff_t i, std::ptrdiff_t j,
                        typename L::M near, V pull, const Triple<L>& apart, Energy&& energy_of) {
    if constexpr (pass != forces_pairwise || energy) count = L::add_where(near, count, L::all(1));
    if constexpr (pass == counts) return;
    push(near, pull, apart, energy_of);
    if constexpr (pass == forces_to_the_mean) {
      su = L::add_where(near, su, L::load(step.before.v[0] + j));
      sv = L::add_where(near, sv, L::load(step.before.v[1] + j));
      sw = L::add_where(near, sw, L::load(step.before.v[2] + j));
    } else if constexpr (pass == forces_pairwise) {
      add_pairwise(step, i, j, near, apart);
    }
  }

  /// Adds a force alone.
  template <class Energy>
  SINEW_INLINE void push(typename L::M near, V pull, const Triple<L>& apart, Energy&& energy_of) {
    pull = L::keep(near, pull);
    fx = L::fused(pull, apart.x, fx);
    fy = L::fused(pull, apart.y, fy);
    fz = L::fused(pull, apart.z, fz);
    if constexpr (energy)
      stored = L::add_where(near, stored, L::all(typename L::Real(0.5)) * energy_of());
  }

  SINEW_INLINE void add_pairwise(const Step<typename L::Real>& step, std::ptrdiff_t i,
                                 std::ptrdiff_t j, typename L::M near, const Triple<L>& apart) {
    const V inverse_counts = L::load(step.inverse_count + i) + L::load(step.inverse_count + j);
    Triple<L> relative = load<L>(step.before.v, j) - load<L>(step.before.v, i);
    if (step.central) relative = (dot<L>(relative, apart) / squared_distance<L>(apart)) * apart;
    su = L::add_where(near, su, inverse_counts * relative.x);
    sv = L::add_where(near, sv, inverse_counts * relative.y);
    sw = L::add_where(near, sw, inverse_counts * relative.z);
  }

  SINEW_INLINE PairSums<L> sums() const { return {{fx, fy, fz}, {su, sv, sw}, count, stored}; }
};

/// The differences of a list, for all lanes.
template <class L>
struct Differences {
  const std::int32_t *begin, *end;

  SINEW_INLINE typename L::V of_lanes(const std::int32_t*, typename L::V squared) const {
    return squared;
  }
};

/// Differences that are each for some lanes: to the others nothing is near.
template <class L>
struct DifferencesOfLanes {
  const std::int32_t *begin, *end;
  const std::uint16_t* lanes;
  int lane;
  typename L::V far;

  SINEW_INLINE typename L::V of_lanes(const std::int32_t* difference, typename L::V squared) const {
    const std::uint32_t own = static_cast<std::uint32_t>(lanes[difference - begin]) >> lane;
    return L::pick(L::mask(own), squared, far);
  }
};

/// The sums over differences; `least` becomes the least squared distance.
/// `careful` handles all distances; without it, those for which `law` needs no care.
template <class L, Pass pass, bool energy, bool careful, class List>
SINEW_INLINE PairSums<L> sum_pairs(const Step<typename L::Real>& step, const PullLaw<L>& law,
                                   std::ptrdiff_t i, const List& list, typename L::V& least) {
  using V = typename L::V;
  const Place<L> here = load_place<L>(step.before.x, i);
  const V b2 = L::all(step.law.b2);
  Adder<L, pass, energy> adder;
  V closest = b2;
  for (const std::int32_t* difference = list.begin; difference != list.end; ++difference) {
    const std::ptrdiff_t j = i + *difference;
    Triple<L> apart = offset<L>(here, load_place<L>(step.before.x, j));
    const V squared = list.of_lanes(difference, squared_distance<L>(apart));
    const auto near = L::less(squared, b2);
    if (!L::any(near)) continue;
    closest = L::smaller(squared, closest);
    V d, pull = L::all(0);
    if constexpr (pass != counts) pull = law.template pull<careful>(squared, d);
    if constexpr (careful) part<L>(step, i, j, squared, push_of<L>(step.law), pull, d, apart.x);
    adder.add(step, i, j, near, pull, apart, [&] { return potential<L>(step.law, d); });
  }
  least = closest;
  return adder.sums();
}

/// A function of its own, so that the fast path keeps values in registers. Whether care was needed.
template <class L, Pass pass, class List>
[[gnu::noinline]] bool sum_pairs_carefully(const Step<typename L::Real>& step, std::ptrdiff_t i,
                                           List list, PairSums<L>& sums) {
  const PullLaw<L> law(step.law);
  typename L::V least;
  const PairSums<L> careful = sum_pairs<L, pass, false, true>(step, law, i, list, least);
  sums.force = {careful.force.x, careful.force.y, careful.force.z};
  sums.velocities = {careful.velocities.x, careful.velocities.y, careful.velocities.z};
  sums.count = careful.count;
  return law.needs_care(least, careful.force.x);
}

/// Makes the sums of the vector at i, which need care in a few places of a body, mostly where they
/// did in the step before: careful(sums) repeats what fast() has done. Both tell whether they
/// needed it. What is counted or probed is not repeated.
template <class L, Pass pass, bool energy, class Fast, class Careful>
SINEW_INLINE void sum_with_care(const Step<typename L::Real>& step, std::ptrdiff_t i,
                                PairSums<L>& sums, const Fast& fast, const Careful& careful) {
  const auto repeat = [&]() __attribute__((always_inline)) {
    PairSums<L> repeated;
    const bool needed = careful(repeated);
    sums = repeated;
    return needed;
  };
  if constexpr (pass == counts || energy) {
    fast();
  } else if constexpr (sizeof(typename L::Real) == 4) {
    if (fast()) [[unlikely]]
      repeat();
  } else {
    std::uint8_t& cared = step.careful[i / L::width];
    if (cared != 0 || fast()) [[unlikely]]
      cared = repeat() ? 1 : 0;
  }
}

/// With energies, what is probed and not stepped, always with care.
template <class L, Pass pass, bool energy, class List>
SINEW_INLINE PairSums<L> pair_sums(const Step<typename L::Real>& step, const PullLaw<L>& law,
                                   std::ptrdiff_t i, const List& list) {
  typename L::V least;
  PairSums<L> sums;
  sum_with_care<L, pass, energy>(
      step, i, sums,
      [&]() __attribute__((always_inline)) {
        sums = sum_pairs<L, pass, energy, energy>(step, law, i, list, least);
        return law.needs_care(least, sums.force.x);
      },
      [&](PairSums<L> & all) __attribute__((always_inline)) {
        return sum_pairs_carefully<L, pass>(step, i, list, all);
      });
  return sums;
}

/// Eq. 2.
template <class L, Pass pass>
SINEW_INLINE Triple<L> damping_of(const PairSums<L>& sums, typename L::V rate,
                                  const Triple<L>& velocity) {
  if constexpr (pass == forces_pairwise)
    return (rate * L::all(static_cast<typename L::Real>(0.5))) * sums.velocities;
  const auto some = L::less(L::all(0), rate * sums.count);
  const typename L::V inverse_count = L::all(1) / L::larger(sums.count, L::all(1));
  const Triple<L> drag = rate * (inverse_count * sums.velocities - velocity);
  return {L::keep(some, drag.x), L::keep(some, drag.y), L::keep(some, drag.z)};
}

}  // namespace sinew::kernel

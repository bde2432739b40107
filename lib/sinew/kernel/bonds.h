// SPDX-License-Identifier: GPL-3.0-or-later
// Forces in materials that know their neighbors at rest: body/solid.h gives them for cells.
#pragma once

#include <sinew/kernel/pairs.h>

namespace sinew::kernel {

/// What bonds and contacts need of the laws, in all lanes.
template <class L>
struct SolidLaw {
  using V = typename L::V;

  SINEW_INLINE explicit SolidLaw(const Step<typename L::Real>& step)
      : pull(step.law),
        inverse(step.law),
        b2(L::all(step.law.b2)),
        touching2(L::all(4 * step.law.r * step.law.r)),
        k1(L::all(step.law.k1 / step.law.r)),
        push(push_of<L>(step.law)),
        breaking(L::all(1 + step.bonds.breaking)) {}

  PullLaw<L> pull;
  InverseLength<L> inverse;
  V b2, touching2, k1, push, breaking;
};

/// What a vector's bonds and contacts have met.
template <class L>
struct Met {
  typename L::V least, most;           ///< squared distances
  typename L::V strained = L::all(0);  ///< positive where a bond creeps or breaks
};

/// The bonds of a vector with the particles at one difference.
template <class L>
struct Bond {
  const BondKind<typename L::Real>* kind;
  std::ptrdiff_t difference;
  typename L::M mask;
  std::size_t place;     ///< place of its values by entry and lane
  typename L::V length;  ///< with what it has crept
  typename L::V stiffness;
  typename L::V free_length, slope;  ///< terms of its force, slope (free_length - d)
};

/// With branches, which relax while the force acts: of their state before and after the mean.
template <class L>
SINEW_INLINE void add_branches(const Bonds<typename L::Real>& bonds, Bond<L>& bond) {
  for (int b = 0; b < bonds.branches; ++b) {
    const Branch<typename L::Real>& branch = bonds.branch[b];
    bond.free_length =
        L::fused(L::all(branch.weight), L::load(branch.stretch + bond.place), bond.free_length);
  }
  bond.slope = L::all(bonds.slope) * bond.slope;
}

/// Calls visit(bond, entry) for the entries [begin, end) of a block's bonds, as a vector has them.
template <class L, PairLaw pairs, class Visit>
SINEW_INLINE void for_each_bond(const Bonds<typename L::Real>& bonds, std::uint32_t begin,
                                std::uint32_t end, int lane, Visit&& visit) {
  constexpr int size = Traits<typename L::Real>::block;
  constexpr std::uint32_t own = (std::uint64_t{1} << L::width) - 1;
  for (std::uint32_t e = begin; e != end; ++e) {
    const BondEntry& entry = bonds.entries[e];
    const std::uint32_t lanes = (entry.lanes >> lane) & own;
    if (size != L::width && lanes == 0) continue;
    const BondKind<typename L::Real>& kind = bonds.kinds[entry.kind];
    typename L::V length = L::all(kind.length);
    if (bonds.creep != nullptr)
      length = length + L::load(bonds.creep + static_cast<std::size_t>(e) * size + lane);
    const typename L::V stiffness =
        entry.own < 0 ? L::all(kind.stiffness)
                      : L::load(bonds.own + static_cast<std::size_t>(entry.own) * size + lane);
    const std::size_t place = static_cast<std::size_t>(e) * size + lane;
    Bond<L> bond{&kind,  entry.difference, L::mask(lanes), place,
                 length, stiffness,        length,         stiffness};
    if constexpr (pairs == changing_springs)
      if (bonds.branches > 0) add_branches<L>(bonds, bond);
    visit(bond, e);
  }
}

/// Nearest neighbors are 2r apart at rest, second ones sqrt(2) times that.
enum Shell { nearest, second };

/// The squared distance as if the shell were the nearest one.
template <class L, Shell shell>
SINEW_INLINE typename L::V nearer(typename L::V squared) {
  return shell == nearest ? squared : squared * L::all(static_cast<typename L::Real>(0.5));
}

/// 1 / d, for the distances that the shell's bonds usually have.
template <class L, Shell shell, bool careful>
SINEW_INLINE typename L::V inverse_length(const SolidLaw<L>& law, typename L::V squared) {
  if constexpr (shell == nearest) return law.inverse.template of<careful>(squared);
  constexpr double root_of_half = 0.70710678118654752;
  return law.inverse.template of<careful>(nearer<L, shell>(squared)) *
         L::all(static_cast<typename L::Real>(root_of_half));
}

/// f / d of a spring.
template <class L, Shell shell, bool careful>
SINEW_INLINE typename L::V spring(const SolidLaw<L>& law, const Bond<L>& bond,
                                  typename L::V squared, typename L::V& d) {
  const typename L::V k = bond.slope;
  const typename L::V inverse = inverse_length<L, shell, careful>(law, squared);
  d = squared * inverse;
  return L::fused(k * bond.free_length, inverse, L::all(0) - k);
}

/// With that in its branches.
template <class L>
SINEW_INLINE typename L::V spring_energy(const Bonds<typename L::Real>& bonds, const Bond<L>& bond,
                                         typename L::V d) {
  const typename L::V longer = d - bond.length;
  typename L::V squares = longer * longer;
  for (int b = 0; b < bonds.branches; ++b) {
    const typename L::V stretch = L::load(bonds.branch[b].stretch + bond.place);
    squares = L::fused(L::all(bonds.branch[b].modulus_ratio) * stretch, stretch - (longer + longer),
                       squares);
  }
  return bond.stiffness * squares * L::all(static_cast<typename L::Real>(0.5));
}

/// Force and energy of bonds: those of springs. A law of one's own specializes it.
template <class L, PairLaw pairs>
struct BondForce {
  using V = typename L::V;

  /// f / d, and the distance d from its square.
  template <Shell shell, bool careful>
  SINEW_INLINE static V pull(const SolidLaw<L>& law, const Bond<L>& bond, V squared, V& d) {
    return spring<L, shell, careful>(law, bond, squared, d);
  }
  SINEW_INLINE static V energy(const Bonds<typename L::Real>& bonds, const Bond<L>& bond, V d) {
    return spring_energy<L>(bonds, bond, d);
  }
};

/// The length at which a bond breaks, over its own.
template <class L>
SINEW_INLINE typename L::V longest(const Step<typename L::Real>& step, const SolidLaw<L>& law,
                                   const Bond<L>& bond, std::ptrdiff_t i) {
  const typename L::Real* of = step.bonds.breaking_of;
  return of == nullptr ? law.breaking
                       : L::smaller(L::load(of + i), L::load(of + i + bond.difference));
}

/// Positive where a bond breaks or creeps.
template <class L>
SINEW_INLINE typename L::V excess(const Step<typename L::Real>& step, const SolidLaw<L>& law,
                                  const Bond<L>& bond, typename L::V d, std::ptrdiff_t i) {
  typename L::V beyond = L::all(0);
  if (step.bonds.breaking > 0)
    beyond = L::larger(beyond, d - longest<L>(step, law, bond, i) * bond.length);
  if (step.bonds.yield > 0) {
    const typename L::V own = L::load(step.bonds.flows + i);
    beyond = L::larger(beyond, L::larger(own, L::load(step.bonds.flows + i + bond.difference)));
  }
  return beyond;
}

/// The energy of eq. 1's repulsion.
template <class L>
SINEW_INLINE typename L::V repulsion_energy(const Law<typename L::Real>& law, typename L::V d) {
  const typename L::V r = L::all(law.r), overlap = L::larger(r + r - d, L::all(0));
  return L::all(law.k1) * (overlap * overlap) * (L::all(4) * r + d) / (L::all(3) * r);
}

/// Adds a vector's bonds to nearest neighbors.
template <class L, PairLaw pairs, Pass pass, bool energy, bool careful>
SINEW_INLINE void add_bonds(const Step<typename L::Real>& step, const SolidLaw<L>& law,
                            std::size_t block, int lane, std::ptrdiff_t i, const Place<L>& here,
                            Adder<L, pass, energy>& sums, Met<L>& met) {
  using V = typename L::V;
  for_each_bond<L, pairs>(
      step.bonds, step.bonds.first[block], step.bonds.second[block],
      lane, [&](const Bond<L>& bond, std::uint32_t) __attribute__((always_inline)) {
        const std::ptrdiff_t j = i + bond.difference;
        Triple<L> apart = offset<L>(here, load_place<L>(step.before.x, j));
        const V squared = squared_distance<L>(apart);
        [[maybe_unused]] typename L::M counted = bond.mask;
        V d, pull;
        if constexpr (pairs == among_neighbors) {
          const auto near = L::less(L::pick(bond.mask, squared, law.b2), law.b2);
          counted = near;
          pull = law.pull.template pull<careful>(squared, d);
          if constexpr (careful) part<L>(step, i, j, squared, law.push, pull, d, apart.x);
          sums.add(step, i, j, near, pull, apart, [&] { return potential<L>(step.law, d); });
        } else {
          pull = BondForce<L, pairs>::template pull<nearest, careful>(law, bond, squared, d);
          if constexpr (careful)
            part<L>(step, i, j, squared, bond.slope * bond.free_length, pull, d, apart.x);
          if constexpr (pairs == changing_springs)
            met.strained =
                L::larger(met.strained, L::keep(bond.mask, excess<L>(step, law, bond, d, i)));
          sums.add(step, i, j, bond.mask, pull, apart,
                   [&] { return BondForce<L, pairs>::energy(step.bonds, bond, d); });
        }
        if constexpr (sizeof(typename L::Real) == 8) {
          const V met_at = L::pick(counted, squared, law.touching2);
          met.least = L::smaller(met_at, met.least), met.most = L::larger(met_at, met.most);
        }
      });
}

/// Adds its bonds to second neighbors, which count for nothing but their springs.
template <class L, PairLaw pairs, Pass pass, bool energy, bool careful>
SINEW_INLINE void add_second(const Step<typename L::Real>& step, const SolidLaw<L>& law,
                             std::size_t block, int lane, std::ptrdiff_t i, const Place<L>& here,
                             Adder<L, pass, energy>& sums, Met<L>& met) {
  using V = typename L::V;
  for_each_bond<L, pairs>(
      step.bonds, step.bonds.second[block], step.bonds.first[block + 1],
      lane, [&](const Bond<L>& bond, std::uint32_t) __attribute__((always_inline)) {
        const std::ptrdiff_t j = i + bond.difference;
        Triple<L> apart = offset<L>(here, load_place<L>(step.before.x, j));
        const V squared = squared_distance<L>(apart);
        V d, pull = BondForce<L, pairs>::template pull<second, careful>(law, bond, squared, d);
        if constexpr (careful)
          part<L>(step, i, j, squared, bond.slope * bond.free_length, pull, d, apart.x);
        if constexpr (pairs == changing_springs)
          met.strained =
              L::larger(met.strained, L::keep(bond.mask, excess<L>(step, law, bond, d, i)));
        sums.push(bond.mask, pull, apart,
                  [&] { return BondForce<L, pairs>::energy(step.bonds, bond, d); });
        if constexpr (sizeof(typename L::Real) == 8) {
          const V met_at = L::pick(bond.mask, nearer<L, second>(squared), law.touching2);
          met.least = L::smaller(met_at, met.least), met.most = L::larger(met_at, met.most);
        }
      });
}

/// Adds its contacts: pairs that touch and are not bonded.
template <class L, Pass pass, bool energy, bool careful>
SINEW_INLINE void add_contacts(const Step<typename L::Real>& step, const SolidLaw<L>& law,
                               std::size_t block, int lane, std::ptrdiff_t i, const Place<L>& here,
                               Adder<L, pass, energy>& sums, Met<L>& met) {
  using V = typename L::V;
  const Lists& lists = step.lists[block / blocks_per_piece];
  const std::uint32_t* first = lists.first + block % blocks_per_piece;
  for (std::uint32_t n = first[0]; n != first[1]; ++n) {
    const std::ptrdiff_t j = i + lists.value[n];
    Triple<L> apart = offset<L>(here, load_place<L>(step.before.x, j));
    const V squared = L::pick(L::mask(static_cast<std::uint32_t>(lists.lanes[n]) >> lane),
                              squared_distance<L>(apart), law.touching2);
    const auto near = L::less(squared, law.touching2);
    if (!L::any(near)) continue;
    const V inverse = law.inverse.template of<careful>(squared);
    V d = squared * inverse;
    V pull = L::less_fused(law.k1, squared, law.push) * inverse;
    if constexpr (careful) part<L>(step, i, j, squared, law.push, pull, d, apart.x);
    sums.add(step, i, j, near, pull, apart, [&] { return repulsion_energy<L>(step.law, d); });
    if constexpr (sizeof(typename L::Real) == 8) met.least = L::smaller(squared, met.least);
  }
}

/// The sums over both. `careful` handles all distances; without it, those for which the law's
/// `inverse` is made.
template <class L, PairLaw pairs, Pass pass, bool energy, bool careful>
SINEW_INLINE PairSums<L> sum_partners(const Step<typename L::Real>& step, const SolidLaw<L>& law,
                                      std::size_t block, int lane, Met<L>& met) {
  const std::ptrdiff_t i =
      static_cast<std::ptrdiff_t>(block) * Traits<typename L::Real>::block + lane;
  const Place<L> here = load_place<L>(step.before.x, i);
  Adder<L, pass, energy> sums;
  Met<L> now{law.touching2, law.touching2};
  add_bonds<L, pairs, pass, energy, careful>(step, law, block, lane, i, here, sums, now);
  if constexpr (pass != counts && pairs != among_neighbors)
    add_second<L, pairs, pass, energy, careful>(step, law, block, lane, i, here, sums, now);
  add_contacts<L, pass, energy, careful>(step, law, block, lane, i, here, sums, now);
  met = now;
  return sums.sums();
}

template <class L>
SINEW_INLINE bool needs_care(const SolidLaw<L>& law, const Met<L>& met, typename L::V force) {
  if constexpr (sizeof(typename L::Real) == 4)
    return !L::every(L::at_most(force, force));
  else
    return L::any(L::less(met.least, law.inverse.least)) ||
           L::any(L::less(law.inverse.most, met.most));
}

/// A function of its own, so that the fast path keeps values in registers. Whether care was needed.
template <class L, PairLaw pairs, Pass pass>
[[gnu::noinline]] bool sum_partners_carefully(const Step<typename L::Real>& step, std::size_t block,
                                              int lane, PairSums<L>& sums, Met<L>& met) {
  const SolidLaw<L> law(step);
  sums = sum_partners<L, pairs, pass, false, true>(step, law, block, lane, met);
  return needs_care(law, met, sums.force.x);
}

template <class L, PairLaw pairs, Pass pass, bool energy>
SINEW_INLINE PairSums<L> partner_sums(const Step<typename L::Real>& step, const SolidLaw<L>& law,
                                      std::size_t block, int lane, bool& strained) {
  const std::ptrdiff_t i =
      static_cast<std::ptrdiff_t>(block) * Traits<typename L::Real>::block + lane;
  Met<L> met;
  PairSums<L> sums;
  sum_with_care<L, pass, energy>(
      step, i, sums,
      [&]() __attribute__((always_inline)) {
        sums = sum_partners<L, pairs, pass, energy, energy>(step, law, block, lane, met);
        return needs_care(law, met, sums.force.x);
      },
      [&](PairSums<L> & all) __attribute__((always_inline)) {
        Met<L> of_all;
        const bool needed = sum_partners_carefully<L, pairs, pass>(step, block, lane, all, of_all);
        met = of_all;
        return needed;
      });
  strained = pairs == changing_springs && L::any(L::less(L::all(0), met.strained));
  return sums;
}

/// The energy of a particle's volume.
template <class L>
SINEW_INLINE typename L::V volume_energy(const Volumes<typename L::Real>& volumes,
                                         std::ptrdiff_t i) {
  const typename L::V growth = L::load(volumes.growth + i);
  return L::all(static_cast<typename L::Real>(0.5)) * L::load(volumes.stiffness + i) *
         (growth * growth);
}

}  // namespace sinew::kernel

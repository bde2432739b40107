// SPDX-License-Identifier: GPL-3.0-or-later
// Bonds that creep, relax and break: body/solid.h and material/maxwell.h give the laws.
#pragma once

#include <sinew/kernel/bonds.h>

namespace sinew::kernel {

/// A symmetric tensor: x x, y y, z z, y z, z x, x y.
template <class L>
struct Symmetric {
  typename L::V at[6];
};

template <class L>
SINEW_INLINE Symmetric<L> squares(const Triple<L>& a) {
  return {{a.x * a.x, a.y * a.y, a.z * a.z, a.y * a.z, a.z * a.x, a.x * a.y}};
}

/// a : b.
template <class L>
SINEW_INLINE typename L::V product(const Symmetric<L>& a, const Symmetric<L>& b) {
  const typename L::V normal =
      L::fused(a.at[0], b.at[0], L::fused(a.at[1], b.at[1], a.at[2] * b.at[2]));
  const typename L::V shear =
      L::fused(a.at[3], b.at[3], L::fused(a.at[4], b.at[4], a.at[5] * b.at[5]));
  return L::fused(L::all(2), shear, normal);
}

/// Sums over a particle's bonds: w, p, w n n^T, p n n^T.
template <class L>
struct StressSums {
  typename L::V weights = L::all(0), pulls = L::all(0);
  Symmetric<L> spread = {{weights, weights, weights, weights, weights, weights}};
  Symmetric<L> stress = spread;
};

/// FlowLook of a piece, by lane.
template <class L>
struct LookSums {
  typename L::V spare, nearest2, reach = L::all(0), tension = reach;

  SINEW_INLINE void add(typename L::M mask, typename L::V squared, typename L::V d,
                        typename L::V free_length) {
    const typename L::V off = L::size(d - free_length);
    nearest2 = L::pick(mask, L::smaller(squared, nearest2), nearest2);
    reach = L::larger(L::keep(mask, d + off), reach);
    tension = L::larger(L::keep(mask, off * d), tension);
  }

  FlowLook<typename L::Real> over_lanes() const {
    using Real = typename L::Real;
    Real rows[4][L::width];
    L::store(rows[0], spare), L::store(rows[1], nearest2);
    L::store(rows[2], reach), L::store(rows[3], tension);
    FlowLook<Real> all{rows[0][0], rows[2][0], rows[3][0], rows[1][0]};
    for (int k = 1; k < L::width; ++k) {
      all.spare = rows[0][k] < all.spare ? rows[0][k] : all.spare;
      all.nearest2 = rows[1][k] < all.nearest2 ? rows[1][k] : all.nearest2;
      all.reach = rows[2][k] > all.reach ? rows[2][k] : all.reach;
      all.tension = rows[3][k] > all.tension ? rows[3][k] : all.tension;
    }
    return all;
  }
};

template <class L, Shell shell>
SINEW_INLINE void add_stress(const Step<typename L::Real>& step, const SolidLaw<L>& law,
                             std::size_t block, int lane, std::ptrdiff_t i, const Place<L>& here,
                             StressSums<L>& sums, LookSums<L>& look) {
  using V = typename L::V;
  const std::uint32_t between = step.bonds.second[block];
  for_each_bond<L, changing_springs>(
      step.bonds, shell == nearest ? step.bonds.first[block] : between,
      shell == nearest ? between : step.bonds.first[block + 1],
      lane, [&](const Bond<L>& bond, std::uint32_t) __attribute__((always_inline)) {
        const Triple<L> apart = offset<L>(here, load_place<L>(step.before.x, i + bond.difference));
        const V squared = L::pick(bond.mask, squared_distance<L>(apart), law.touching2);
        const V inverse = L::pick(L::less(L::all(0), squared),
                                  inverse_length<L, shell, true>(law, squared), L::all(0));
        const V k = L::keep(bond.mask, bond.stiffness), l0 = L::all(bond.kind->length);
        const V d = squared * inverse, weight = k * l0 * l0;
        const V pull = L::keep(bond.mask, bond.slope) * (d - bond.free_length) * d;
        look.add(bond.mask, squared, d, bond.free_length);
        const V inverse2 = inverse * inverse;
        const Symmetric<L> nn = squares<L>(apart);
        sums.weights = sums.weights + weight;
        sums.pulls = sums.pulls + pull;
        for (int n = 0; n < 6; ++n) {
          const V part = L::keep(bond.mask, nn.at[n] * inverse2);
          sums.spread.at[n] = L::fused(weight, part, sums.spread.at[n]);
          sums.stress.at[n] = L::fused(pull, part, sums.stress.at[n]);
        }
      });
}

/// D, the deviator of its elastic strain.
template <class L>
SINEW_INLINE Symmetric<L> shear_of(const StressSums<L>& sums) {
  using V = typename L::V;
  using Real = typename L::Real;
  const V per_weight =
      L::pick(L::less(L::all(0), sums.weights), L::all(1) / sums.weights, L::all(0));
  const V mean = sums.pulls * per_weight, scale = L::all(Real(7.5)) * per_weight;
  Symmetric<L> D;
  for (int k = 0; k < 6; ++k) D.at[k] = scale * (sums.stress.at[k] - mean * sums.spread.at[k]);
  const V third = (D.at[0] + D.at[1] + D.at[2]) * L::all(Real(1.0 / 3));
  for (int k = 0; k < 3; ++k) D.at[k] = D.at[k] - third;
  return D;
}

/// P of a vector.
template <class L>
SINEW_INLINE void find_flow(const Step<typename L::Real>& step, const SolidLaw<L>& law,
                            std::size_t block, int lane, LookSums<L>& look) {
  using V = typename L::V;
  const std::ptrdiff_t i =
      static_cast<std::ptrdiff_t>(block) * Traits<typename L::Real>::block + lane;
  const Place<L> here = load_place<L>(step.before.x, i);
  StressSums<L> sums;
  add_stress<L, nearest>(step, law, block, lane, i, here, sums, look);
  add_stress<L, second>(step, law, block, lane, i, here, sums, look);
  const Symmetric<L> D = shear_of<L>(sums);
  const V shear = product<L>(D, D);
  const V yield =
      step.bonds.yield_of == nullptr ? L::all(step.bonds.yield) : L::load(step.bonds.yield_of + i);
  const V flows =
      L::keep(L::less(yield, shear), L::all(1) - L::root(yield / L::larger(shear, yield)));
  look.spare = L::smaller(L::root(yield) - L::root(shear), look.spare);
  L::store(step.bonds.flows + i, flows);
  for (int k = 0; k < 6; ++k) L::store(step.bonds.flow[k] + i, flows * D.at[k]);
}

/// P of all particles of the pieces [begin, end).
template <class L>
void flow_pieces(const Step<typename L::Real>& step, std::size_t begin, std::size_t end) {
  constexpr int size = Traits<typename L::Real>::block;
  constexpr auto far = static_cast<typename L::Real>(1e30);
  const SolidLaw<L> law(step);
  for (std::size_t piece = begin; piece < end; ++piece) {
    LookSums<L> look{L::all(far), L::all(far)};
    const std::size_t first = piece * blocks_per_piece, last = first + blocks_per_piece;
    for (std::size_t block = first; block < last && block < step.blocks; ++block)
      for (int lane = 0; lane < size; lane += L::width) find_flow<L>(step, law, block, lane, look);
    step.bonds.look[piece] = look.over_lanes();
  }
}

/// Lets the branches of a vector's bonds relax at the distances that they have, both directions of
/// a bond alike. Adds the energy that is lost, per time, to `lost`.
template <class L, Shell shell>
[[gnu::noinline]] void relax_bonds(const Step<typename L::Real>& step, std::size_t block, int lane,
                                   typename L::Real* lost) {
  using V = typename L::V;
  using Real = typename L::Real;
  const Bonds<Real>& bonds = step.bonds;
  const std::ptrdiff_t i = static_cast<std::ptrdiff_t>(block) * Traits<Real>::block + lane;
  const Place<L> here = load_place<L>(step.before.x, i);
  const auto relax = [&](const Bond<L>& bond, std::uint32_t) {
    const Triple<L> apart = offset<L>(here, load_place<L>(step.before.x, i + bond.difference));
    const V d = L::root(squared_distance<L>(apart));
    const V longer = L::keep(bond.mask, d - bond.length);
    V freed = L::all(0);
    for (int b = 0; b < bonds.branches; ++b) {
      const Branch<Real>& branch = bonds.branch[b];
      if (branch.flows == 0) continue;
      Real* const stretch = branch.stretch + bond.place;
      const V before = L::load(stretch), elastic = L::keep(bond.mask, longer - before);
      L::store(stretch, L::fused(L::all(branch.flows), elastic, before));
      const Real weight = branch.modulus_ratio * branch.flows * (2 - branch.flows);
      freed = L::fused(L::all(weight), elastic * elastic, freed);
    }
    add_to<L>(lost, L::keep(bond.mask, bond.stiffness * freed) * L::all(Real(0.25) / step.drift));
  };
  const std::uint32_t *first = bonds.first + block, *between = bonds.second + block;
  for_each_bond<L, changing_springs>(bonds, shell == nearest ? *first : *between,
                                     shell == nearest ? *between : first[1], lane, relax);
}

/// A particle that lost a bond keeps its volume no longer. Returns the energy that is lost.
template <class Real>
Real forget_volume(const Volumes<Real>& volumes, std::ptrdiff_t i) {
  const Real growth = volumes.growth[i];
  const Real energy = volumes.stiffness[i] * growth * growth / 2;
  volumes.stiffness[i] = 0;
  return energy;
}

/// Lets a bond creep. Returns the energy that is lost: while it yields it grows, and its pull is
/// that of the middle of the step.
template <class L>
SINEW_INLINE typename L::V flow_of_bond(const Step<typename L::Real>& step, const Bond<L>& bond,
                                        std::ptrdiff_t i, const Triple<L>& apart,
                                        typename L::V inverse, typename L::V d) {
  using V = typename L::V;
  using Real = typename L::Real;
  const std::ptrdiff_t j = i + bond.difference;
  Symmetric<L> P;
  for (int k = 0; k < 6; ++k)
    P.at[k] = L::load(step.bonds.flow[k] + i) + L::load(step.bonds.flow[k] + j);
  const V strain = product<L>(P, squares<L>(apart)) * (inverse * inverse);
  const V by = L::keep(bond.mask, L::all(step.bonds.crept * Real(0.5)) * bond.length * strain);
  Real* crept = step.bonds.creep + bond.place;
  const V total = L::load(crept) + by;
  L::store(crept, total);
  Bond<L> after = bond;
  after.length = L::all(bond.kind->length) + total;
  const Triple<L> parting = load<L>(step.before.v, i) - load<L>(step.before.v, j);
  const V growth = L::all(step.drift * Real(0.5)) * dot<L>(parting, apart) * inverse;
  return spring_energy<L>(step.bonds, bond, d) - spring_energy<L>(step.bonds, after, d) +
         bond.stiffness * by * growth;
}

/// Lets the bonds of a vector creep and break: both directions of a bond see the same distance to
/// the last bit, and change alike. Adds the energy that is lost, per time, to `lost`. A pair whose
/// bond broke repels like any other.
template <class L, Shell shell>
[[gnu::noinline]] void change_bonds(const Step<typename L::Real>& step, std::size_t block, int lane,
                                    typename L::Real* lost, bool& broke) {
  using V = typename L::V;
  using Real = typename L::Real;
  constexpr int size = Traits<Real>::block;
  const SolidLaw<L> law(step);
  const std::ptrdiff_t i = static_cast<std::ptrdiff_t>(block) * size + lane;
  const Place<L> here = load_place<L>(step.before.x, i);
  const bool repels = shell == second;  // once it is broken as before
  const auto change = [&](const Bond<L>& bond, std::uint32_t e) {
    const Triple<L> apart = offset<L>(here, load_place<L>(step.before.x, i + bond.difference));
    // Repeats the sums, so that a bond that counts as strained there is so here.
    const V squared = L::pick(bond.mask, squared_distance<L>(apart), law.touching2);
    const V inverse = L::pick(L::less(L::all(0), squared),
                              inverse_length<L, shell, true>(law, squared), L::all(0));
    const V d = squared * inverse;
    V freed = L::all(0);
    if (step.bonds.yield > 0) freed = flow_of_bond<L>(step, bond, i, apart, inverse, d);
    if (step.bonds.breaking > 0) {
      const auto breaks = L::less(L::keep(bond.mask, longest<L>(step, law, bond, i) * bond.length),
                                  L::keep(bond.mask, d));
      if (L::any(breaks)) {
        broke = true;
        Real gone[L::width];
        L::store(gone, L::keep(breaks, L::all(1)));
        for (int n = 0; n < L::width; ++n) {
          if (gone[n] == 0) continue;
          step.bonds.entries[e].lanes &= ~(std::uint32_t{1} << (lane + n));
          ++step.bonds.broken[i + n];
          if (step.volumes.stiffness != nullptr)
            lost[n] += forget_volume(step.volumes, i + n) / step.drift;
        }
        const V kept = repels ? L::all(0) : repulsion_energy<L>(step.law, d);
        freed = L::pick(breaks, spring_energy<L>(step.bonds, bond, d) - kept, freed);
      }
    }
    add_to<L>(lost, L::keep(bond.mask, freed) * L::all(Real(0.5) / step.drift));
  };
  const std::uint32_t *first = step.bonds.first + block, *between = step.bonds.second + block;
  for_each_bond<L, changing_springs>(step.bonds, shell == nearest ? *first : *between,
                                     shell == nearest ? *between : first[1], lane, change);
}

}  // namespace sinew::kernel

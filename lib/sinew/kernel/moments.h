// SPDX-License-Identifier: GPL-3.0-or-later
// Sums over the particles of a group: forces times the terms of their places, by which the group
// moves. Lanes are summed by their place in the block, whatever the width.
#pragma once

#include <sinew/kernel/bones.h>
#include <sinew/kernel/fetching.h>

namespace sinew::kernel {

/// The first terms of a place, in the order of groups/cubic/polynomials.h.
template <class L, int terms>
struct TermsOf {
  using V = typename L::V;
  V term[terms];

  SINEW_INLINE explicit TermsOf(const Triple<L>& at) {
    const V x = at.x, y = at.y, z = at.z;
    term[0] = L::all(1), term[1] = x, term[2] = y, term[3] = z;
    if constexpr (terms >= square_terms) {
      term[4] = x * x, term[5] = x * y, term[6] = x * z;
      term[7] = y * y, term[8] = y * z, term[9] = z * z;
    }
    if constexpr (terms >= cubic_terms) {
      for (int k = 0; k < 6; ++k) term[10 + k] = x * term[4 + k];
      for (int k = 0; k < 3; ++k) term[16 + k] = y * term[7 + k];
      term[19] = z * term[9];
    }
  }
};

/// Sums by place in the block.
template <class L, int terms>
struct MomentSums {
  using Real = typename L::Real;
  static constexpr int block = Traits<Real>::block;
  Real sum[3][terms][block] = {};

  SINEW_INLINE void add(int lane, const Triple<L>& f, const TermsOf<L, terms>& at) {
    const typename L::V fs[3] = {f.x, f.y, f.z};
    for (int axis = 0; axis < 3; ++axis)
      for (int k = 0; k < terms; ++k) {
        Real* to = sum[axis][k] + lane;
        L::store(to, L::fused(fs[axis], at.term[k], L::load(to)));
      }
  }

  /// Axis by axis `stride` long.
  void put(double* out, int stride) const {
    for (int axis = 0; axis < 3; ++axis)
      for (int k = 0; k < stride; ++k)
        out[axis * stride + k] = k < terms ? sum_of<L>(sum[axis][k]) : 0;
  }
};

template <class L>
SINEW_INLINE Triple<L> kept(typename L::M mask, const Triple<L>& a) {
  return {L::keep(mask, a.x), L::keep(mask, a.y), L::keep(mask, a.z)};
}

template <class L, int terms>
void sum_moments(const MomentInput<typename L::Real>& input, TermSums& out) {
  constexpr int size = Traits<typename L::Real>::block;
  MomentSums<L, terms> sums;
  for (std::size_t begin = 0; begin < input.count; begin += size)
    for (int lane = 0; lane < size; lane += L::width) {
      const auto at = static_cast<std::ptrdiff_t>(begin) + lane;
      const auto left = static_cast<std::ptrdiff_t>(input.count) - at;
      if (left <= 0) break;
      const auto lanes = left >= L::width ? ~std::uint32_t{0} : (std::uint32_t{1} << left) - 1;
      const auto mask = L::mask(lanes & ((std::uint64_t{1} << L::width) - 1));
      sums.add(lane, kept<L>(mask, load<L>(input.force, at)),
               TermsOf<L, terms>(kept<L>(mask, load<L>(input.at, at))));
    }
  sums.put(out.sum, cubic_terms);
}

/// Sums up what bones exert on blocks of one group, times the weights.
template <class L, int terms>
void pull_blocks(const Step<typename L::Real>& step, const PulledBlocks<typename L::Real>& pulled,
                 PullSums& out) {
  using V = typename L::V;
  constexpr int size = Traits<typename L::Real>::block;
  MomentSums<L, terms> force, damping;
  typename L::Real power[size] = {}, lost[size] = {};
  for (std::size_t k = 0; k < pulled.count; ++k) {
    if (k + 1 < pulled.count) fetch_for_pull(step, pulled, pulled.block[k + 1]);
    for (int lane = 0; lane < size; lane += L::width) {
      const std::ptrdiff_t i = static_cast<std::ptrdiff_t>(pulled.block[k]) * size + lane;
      const Triple<L> v = load<L>(step.before.v, i);
      const TermsOf<L, terms> at(load<L>(pulled.at, i));
      const BoneSums<L> bones =
          bone_sums<L, false>(step, pulled.block[k], lane, load_place<L>(step.before.x, i), v);
      const V weight = L::all(static_cast<typename L::Real>(pulled.weight[k]));
      const Triple<L> d = weight * bones.damping;
      force.add(lane, weight * bones.spring + d, at);
      damping.add(lane, d, at);
      add_to<L>(power + lane, weight * bones.power);
      add_to<L>(lost + lane, weight * bones.damping_power - dot<L>(d, v));
    }
  }
  force.put(out.force.sum, cubic_terms);
  damping.put(out.damping.sum, cubic_terms);
  out.power = sum_of<L>(power);
  out.lost = sum_of<L>(lost);
}

/// Sums up what bonds exert on their far ends, times terms of the near ones.
template <class L, int terms>
void pull_group_bonds(const GroupBonds& bonds, double* sums) {
  using V = typename L::V;
  constexpr int size = Traits<double>::block;
  MomentSums<L, terms> pulls;
  const V touching2 = L::all(bonds.touching * bonds.touching);
  const auto apart = [&](int axis, const TermsOf<L, square_terms>& at) {
    const double* c = bonds.apart + axis * square_terms;
    V value = L::all(c[0]);
    for (int k = 1; k < square_terms; ++k) value = L::fused(L::all(c[k]), at.term[k], value);
    return value;
  };
  for (std::size_t begin = 0; begin < bonds.count; begin += size)
    for (int lane = 0; lane < size; lane += L::width) {
      const auto i = static_cast<std::ptrdiff_t>(begin) + lane;
      const Triple<L> place = load<L>(bonds.at, i);
      const TermsOf<L, square_terms> at(place);
      const Triple<L> to{apart(0, at), apart(1, at), apart(2, at)};
      const V squared = dot<L>(to, to), inverse = L::all(1) / L::root(squared);
      const V closer = L::larger(touching2 - squared, L::all(0));
      const V spring = L::load(bonds.weight + i) * (L::all(bonds.length) * inverse - L::all(1));
      const V push = L::load(bonds.contact + i) * (L::all(bonds.push) * closer * inverse);
      pulls.add(lane, (spring + push) * to, TermsOf<L, terms>(place));
    }
  pulls.put(sums, terms);
}

}  // namespace sinew::kernel

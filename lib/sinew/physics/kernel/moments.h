// SPDX-License-Identifier: GPL-3.0-or-later
// Sums over the particles of a group: forces, and their moments with places at rest. Lanes are
// summed by their place in the block, whatever the width.
#pragma once

#include <sinew/physics/kernel/bones.h>

namespace sinew::kernel {

/// By place in the block.
template <class L>
struct MomentSums {
  using Real = typename L::Real;
  static constexpr int block = Traits<Real>::block;
  Real sum[force_moments][block] = {};

  SINEW_INLINE void add(int lane, const Triple<L>& f, const Triple<L>& X) {
    const typename L::V fs[3] = {f.x, f.y, f.z}, Xs[3] = {X.x, X.y, X.z};
    for (int row = 0; row < 3; ++row) {
      add_to<L>(sum[row] + lane, fs[row]);
      for (int column = 0; column < 3; ++column) {
        Real* to = sum[3 + 3 * row + column] + lane;
        L::store(to, L::fused(fs[row], Xs[column], L::load(to)));
      }
    }
  }

  void put(double* out) const {
    for (int k = 0; k < force_moments; ++k) out[k] = sum_of<L>(sum[k]);
  }
};

template <class L>
SINEW_INLINE Triple<L> kept(typename L::M mask, const Triple<L>& a) {
  return {L::keep(mask, a.x), L::keep(mask, a.y), L::keep(mask, a.z)};
}

template <class L>
void sum_moments(const MomentInput<typename L::Real>& input, double* out) {
  constexpr int size = Traits<typename L::Real>::block;
  MomentSums<L> sums;
  for (std::size_t begin = 0; begin < input.count; begin += size)
    for (int lane = 0; lane < size; lane += L::width) {
      const auto at = static_cast<std::ptrdiff_t>(begin) + lane;
      const auto left = static_cast<std::ptrdiff_t>(input.count) - at;
      if (left <= 0) break;
      const auto lanes = left >= L::width ? ~std::uint32_t{0} : (std::uint32_t{1} << left) - 1;
      const auto mask = L::mask(lanes & ((std::uint64_t{1} << L::width) - 1));
      sums.add(lane, kept<L>(mask, load<L>(input.force, at)), kept<L>(mask, load<L>(input.X, at)));
    }
  sums.put(out);
}

/// Of bones on blocks of one group, times the weights.
template <class L>
void pull_blocks(const Step<typename L::Real>& step, const PulledBlocks<typename L::Real>& pulled,
                 PullSums& out) {
  using V = typename L::V;
  constexpr int size = Traits<typename L::Real>::block;
  MomentSums<L> force, damping;
  typename L::Real power[size] = {}, lost[size] = {};
  for (std::size_t k = 0; k < pulled.count; ++k)
    for (int lane = 0; lane < size; lane += L::width) {
      const std::ptrdiff_t i = static_cast<std::ptrdiff_t>(pulled.block[k]) * size + lane;
      const Triple<L> v = load<L>(step.before.v, i), X = load<L>(pulled.X, i);
      const BoneSums<L> bones =
          bone_sums<L, false>(step, pulled.block[k], lane, load_place<L>(step.before.x, i), v);
      const V weight = L::all(static_cast<typename L::Real>(pulled.weight[k]));
      const Triple<L> d = weight * bones.damping;
      force.add(lane, weight * bones.spring + d, X);
      damping.add(lane, d, X);
      add_to<L>(power + lane, weight * bones.power);
      add_to<L>(lost + lane, weight * bones.damping_power - dot<L>(d, v));
    }
  force.put(out.force);
  damping.put(out.damping);
  out.power = sum_of<L>(power);
  out.lost = sum_of<L>(lost);
}

}  // namespace sinew::kernel

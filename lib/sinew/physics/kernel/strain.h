// SPDX-License-Identifier: GPL-3.0-or-later
// Forces that follow from the least-squares deformation gradient F = (sum x X^T) A^-1 around each
// particle, A = sum X X^T over its neighbors at rest: ../solid.h and ../world/muscles.h derive
// them.
#pragma once

#include <sinew/physics/kernel/bonds.h>

namespace sinew::kernel {

/// Row by row.
template <class L>
struct Matrix {
  typename L::V at[9];
};

/// A symmetric one: x x, y y, z z, y z, z x, x y.
template <class L>
SINEW_INLINE Matrix<L> times_symmetric(const Matrix<L>& a, const typename L::V (&s)[6]) {
  Matrix<L> product;
  for (int row = 0; row < 3; ++row) {
    const typename L::V *from = a.at + 3 * row, x = from[0], y = from[1], z = from[2];
    product.at[3 * row] = L::fused(x, s[0], L::fused(y, s[5], z * s[4]));
    product.at[3 * row + 1] = L::fused(x, s[5], L::fused(y, s[1], z * s[3]));
    product.at[3 * row + 2] = L::fused(x, s[4], L::fused(y, s[3], z * s[2]));
  }
  return product;
}

template <class L>
SINEW_INLINE Triple<L> row_of(const Matrix<L>& a, int row) {
  return {a.at[3 * row], a.at[3 * row + 1], a.at[3 * row + 2]};
}

/// Calls visit(entry, mask) for the nearest neighbors at rest of a vector, broken bonds included.
template <class L, class Visit>
SINEW_INLINE void for_each_at_rest(const Bonds<typename L::Real>& bonds, std::size_t block,
                                   int lane, Visit&& visit) {
  constexpr std::uint32_t own = (std::uint64_t{1} << L::width) - 1;
  for (std::uint32_t e = bonds.first[block]; e != bonds.second[block]; ++e) {
    const std::uint32_t lanes = (bonds.entries[e].lanes >> (lane + rest_lanes)) & own;
    if (lanes != 0) visit(bonds.entries[e], L::mask(lanes));
  }
}

template <class L>
SINEW_INLINE Matrix<L> deformation_gradient(const Step<typename L::Real>& step,
                                            const typename L::V (&inverse)[6], std::size_t block,
                                            int lane, std::ptrdiff_t i) {
  using V = typename L::V;
  const Place<L> here = load_place<L>(step.before.x, i);
  V xx = L::all(0), xy = xx, xz = xx, yx = xx, yy = xx, yz = xx, zx = xx, zy = xx, zz = xx;
  for_each_at_rest<L>(
      step.bonds, block,
      lane, [&](const BondEntry& entry, typename L::M mask) __attribute__((always_inline)) {
        const Triple<L> X = all<L>(step.bonds.kinds[entry.kind].rest);
        const Place<L> there = load_place<L>(step.before.x, i + entry.difference);
        Triple<L> to = offset<L>(there, here);
        to = {L::keep(mask, to.x), L::keep(mask, to.y), L::keep(mask, to.z)};
        xx = L::fused(to.x, X.x, xx), xy = L::fused(to.x, X.y, xy), xz = L::fused(to.x, X.z, xz);
        yx = L::fused(to.y, X.x, yx), yy = L::fused(to.y, X.y, yy), yz = L::fused(to.y, X.z, yz);
        zx = L::fused(to.z, X.x, zx), zy = L::fused(to.z, X.y, zy), zz = L::fused(to.z, X.z, zz);
      });
  return times_symmetric<L>(Matrix<L>{{xx, xy, xz, yx, yy, yz, zx, zy, zz}}, inverse);
}

template <class L>
SINEW_INLINE void store_thrust(const Thrust<typename L::Real>& thrust, std::ptrdiff_t i,
                               const Matrix<L>& matrix) {
  for (int k = 0; k < 9; ++k) L::store(thrust[k] + i, matrix.at[k]);
}

/// K_v V0 w (J - 1) cof F A^-1.
template <class L>
SINEW_INLINE void find_volumes(const Volumes<typename L::Real>& volumes, const Matrix<L>& F,
                               const typename L::V (&inverse)[6], std::ptrdiff_t i) {
  using V = typename L::V;
  const Triple<L> a = row_of(F, 0), b = row_of(F, 1), c = row_of(F, 2);
  const Triple<L> cofactors[3] = {cross<L>(b, c), cross<L>(c, a), cross<L>(a, b)};
  const V stiffness = L::load(volumes.stiffness + i);
  const auto kept = L::less(L::all(0), stiffness);
  const V growth = L::keep(kept, dot<L>(a, cofactors[0]) - L::all(1));
  const V pressure = stiffness * growth;
  Matrix<L> thrust;
  for (int row = 0; row < 3; ++row) {
    thrust.at[3 * row] = L::keep(kept, pressure * cofactors[row].x);
    thrust.at[3 * row + 1] = L::keep(kept, pressure * cofactors[row].y);
    thrust.at[3 * row + 2] = L::keep(kept, pressure * cofactors[row].z);
  }
  L::store(volumes.growth + i, growth);
  store_thrust<L>(volumes.thrust, i, times_symmetric<L>(thrust, inverse));
}

/// The sum over fibers of a S w V0 (F t) t^T A^-1 / |F t|^2. A fiber shorter than half its length
/// counts as that long.
template <class L>
SINEW_INLINE void find_fibers(const Fibers<typename L::Real>& fibers, const Matrix<L>& F,
                              const typename L::V (&inverse)[6], std::size_t block, int lane,
                              std::ptrdiff_t i) {
  using V = typename L::V;
  constexpr int size = Traits<typename L::Real>::block;
  Matrix<L> sum;
  for (V& value : sum.at) value = L::all(0);
  for (std::uint32_t s = fibers.first[block]; s != fibers.first[block + 1]; ++s) {
    const std::int32_t muscle = fibers.muscle[s];
    const Triple<L> t = all<L>(fibers.direction + static_cast<std::ptrdiff_t>(3) * muscle);
    const V along[3] = {dot<L>(row_of(F, 0), t), dot<L>(row_of(F, 1), t), dot<L>(row_of(F, 2), t)};
    const V squared =
        L::fused(along[0], along[0], L::fused(along[1], along[1], along[2] * along[2]));
    const V strength = L::load(fibers.strength + static_cast<std::size_t>(s) * size + lane);
    const V pull = L::all(fibers.level[muscle]) * strength /
                   L::larger(squared, L::all(static_cast<typename L::Real>(0.25)));
    const auto some = L::less(L::all(0), L::size(strength));
    for (int row = 0; row < 3; ++row) {
      const V force = L::keep(some, pull * along[row]);
      sum.at[3 * row] = L::fused(force, t.x, sum.at[3 * row]);
      sum.at[3 * row + 1] = L::fused(force, t.y, sum.at[3 * row + 1]);
      sum.at[3 * row + 2] = L::fused(force, t.z, sum.at[3 * row + 2]);
    }
  }
  store_thrust<L>(fibers.thrust, i, times_symmetric<L>(sum, inverse));
}

template <class L>
void strain_pieces(const Step<typename L::Real>& step, std::size_t begin, std::size_t end) {
  constexpr int size = Traits<typename L::Real>::block;
  const std::size_t last = end * blocks_per_piece;
  for (std::size_t block = begin * blocks_per_piece; block < last && block < step.blocks; ++block) {
    if (step.grouped.asleep != nullptr && step.grouped.asleep[block] != 0) continue;
    if (step.volumes.stiffness == nullptr &&
        step.fibers.first[block] == step.fibers.first[block + 1])
      continue;  // what it exerts is zero and remains so
    fetch_for_strain(step, block);
    for (int lane = 0; lane < size; lane += L::width) {
      const std::ptrdiff_t i = static_cast<std::ptrdiff_t>(block) * size + lane;
      typename L::V inverse[6];
      for (int k = 0; k < 6; ++k) inverse[k] = L::load(step.inverse[k] + i);
      const Matrix<L> F = deformation_gradient<L>(step, inverse, block, lane, i);
      if (step.volumes.stiffness != nullptr) find_volumes<L>(step.volumes, F, inverse, i);
      if (step.fibers.first != nullptr) find_fibers<L>(step.fibers, F, inverse, block, lane, i);
    }
  }
}

/// The force of the thrusts around a vector, and its own.
template <class L>
SINEW_INLINE Triple<L> thrust_force(const Step<typename L::Real>& step,
                                    const Thrust<typename L::Real>& thrust, std::size_t block,
                                    int lane, std::ptrdiff_t i) {
  using V = typename L::V;
  V fx = L::all(0), fy = fx, fz = fx, sx = fx, sy = fx, sz = fx;
  for_each_at_rest<L>(
      step.bonds, block,
      lane, [&](const BondEntry& entry, typename L::M mask) __attribute__((always_inline)) {
        const std::ptrdiff_t j = i + entry.difference;
        const Triple<L> rest = all<L>(step.bonds.kinds[entry.kind].rest);
        const Triple<L> X{L::keep(mask, rest.x), L::keep(mask, rest.y), L::keep(mask, rest.z)};
        sx = sx + X.x, sy = sy + X.y, sz = sz + X.z;
        const auto row = [&](int k) __attribute__((always_inline)) {
          return Triple<L>{L::load(thrust[k] + j), L::load(thrust[k + 1] + j),
                           L::load(thrust[k + 2] + j)};
        };
        fx = fx + dot<L>(row(0), X);
        fy = fy + dot<L>(row(3), X);
        fz = fz + dot<L>(row(6), X);
      });
  const Triple<L> X{sx, sy, sz};
  const auto own = [&](int k) {
    return Triple<L>{L::load(thrust[k] + i), L::load(thrust[k + 1] + i),
                     L::load(thrust[k + 2] + i)};
  };
  return {fx + dot<L>(own(0), X), fy + dot<L>(own(3), X), fz + dot<L>(own(6), X)};
}

}  // namespace sinew::kernel

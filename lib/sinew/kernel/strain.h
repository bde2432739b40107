// SPDX-License-Identifier: GPL-3.0-or-later
// Forces that follow from the least-squares deformation gradient F = (sum x X^T) A^-1 around each
// particle, A = sum X X^T over its neighbors at rest: body/solid.h and world/muscles.h derive
// them. Volumes need all of F, and fibers F t alone.
#pragma once

#include <sinew/kernel/bonds.h>

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

/// Calls visit(entry, rows) for what a layer's coefficients are of.
template <class L, class Visit>
SINEW_INLINE void for_each_fiber(const Step<typename L::Real>& step,
                                 const FiberLayer<typename L::Real>& layer, std::size_t block,
                                 Visit&& visit) {
  const Bonds<typename L::Real>& bonds = step.bonds;
  for (std::uint32_t e = bonds.first[block]; e != bonds.second[block]; ++e)
    visit(bonds.entries[e].difference, layer.rows[e]);
}

template <class L>
SINEW_INLINE typename L::V coefficients_of(const FiberLayer<typename L::Real>& layer,
                                           std::uint32_t row, int lane) {
  constexpr int size = Traits<typename L::Real>::block;
  return L::load(layer.coefficients + static_cast<std::size_t>(row) * size + lane);
}

/// a S w V0 F t / |F t|^2. A fiber shorter than half its length counts as that long.
template <class L>
SINEW_INLINE void find_pull(const Step<typename L::Real>& step,
                            const FiberLayer<typename L::Real>& layer, std::size_t block, int lane,
                            std::ptrdiff_t i) {
  using V = typename L::V;
  constexpr int size = Traits<typename L::Real>::block;
  const Place<L> here = load_place<L>(step.before.x, i);
  Triple<L> along = none<L>();
  for_each_fiber<L>(
      step, layer,
      block, [&](std::ptrdiff_t difference, FiberRows rows) __attribute__((always_inline)) {
        const Triple<L> to = offset<L>(load_place<L>(step.before.x, i + difference), here);
        along = fused<L>(coefficients_of<L>(layer, rows.own, lane), to, along);
      });
  V strength = L::all(0);
  for (std::uint32_t s = layer.first[block]; s != layer.first[block + 1]; ++s)
    strength =
        L::fused(L::all(step.fibers.level[layer.muscle[s]]),
                 L::load(layer.strength + static_cast<std::size_t>(s) * size + lane), strength);
  const V squared = L::larger(dot<L>(along, along), L::all(static_cast<typename L::Real>(0.25)));
  const V pull = strength / squared;
  const Triple<L> force = pull * along;
  L::store(layer.pull[0] + i, force.x);
  L::store(layer.pull[1] + i, force.y);
  L::store(layer.pull[2] + i, force.z);
}

/// The force of the fibers of a vector and around it.
template <class L>
SINEW_INLINE Triple<L> fiber_force(const Step<typename L::Real>& step, std::size_t block, int lane,
                                   std::ptrdiff_t i) {
  Triple<L> force = none<L>();
  for (int k = 0; k < step.fibers.count; ++k) {
    const FiberLayer<typename L::Real>& layer = step.fibers.layers[k];
    if (layer.near[block] == 0) continue;
    const auto pull_at = [&](std::ptrdiff_t j) __attribute__((always_inline)) {
      return Triple<L>{L::load(layer.pull[0] + j), L::load(layer.pull[1] + j),
                       L::load(layer.pull[2] + j)};
    };
    for_each_fiber<L>(
        step, layer,
        block, [&](std::ptrdiff_t difference, FiberRows rows) __attribute__((always_inline)) {
          force = fused<L>(coefficients_of<L>(layer, rows.others, lane), pull_at(i + difference),
                           force);
        });
    force = fused<L>(L::load(layer.own + i), pull_at(i), force);
  }
  return force;
}

template <class L>
SINEW_INLINE void find_strain(const Step<typename L::Real>& step, std::size_t block, int lane) {
  const std::ptrdiff_t i =
      static_cast<std::ptrdiff_t>(block) * Traits<typename L::Real>::block + lane;
  if (step.volumes.stiffness != nullptr) {
    typename L::V inverse[6];
    for (int k = 0; k < 6; ++k) inverse[k] = L::load(step.inverse[k] + i);
    const Matrix<L> F = deformation_gradient<L>(step, inverse, block, lane, i);
    find_volumes<L>(step.volumes, F, inverse, i);
  }
  for (int k = 0; k < step.fibers.count; ++k) {
    const FiberLayer<typename L::Real>& layer = step.fibers.layers[k];
    if (layer.first[block] != layer.first[block + 1]) find_pull<L>(step, layer, block, lane, i);
  }
}

/// Whether anything follows from the deformation in a block; elsewhere it is zero and remains so.
template <class Real>
SINEW_INLINE bool has_strain(const Step<Real>& step, std::size_t block) {
  bool any = step.volumes.stiffness != nullptr;
  for (int k = 0; k < step.fibers.count && !any; ++k)
    any = step.fibers.layers[k].first[block] != step.fibers.layers[k].first[block + 1];
  return any;
}

template <class L>
void strain_pieces(const Step<typename L::Real>& step, std::size_t begin, std::size_t end) {
  constexpr int size = Traits<typename L::Real>::block;
  const std::size_t last = end * blocks_per_piece;
  for (std::size_t block = begin * blocks_per_piece; block < last && block < step.blocks; ++block) {
    if (step.grouped.inactive != nullptr && step.grouped.inactive[block] != 0) continue;
    if (!has_strain(step, block)) continue;
    fetch_for_strain(step, block);
    for (int lane = 0; lane < size; lane += L::width) find_strain<L>(step, block, lane);
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

// SPDX-License-Identifier: GPL-3.0-or-later
// Forces that follow from the deformation around each particle, as plain arrays (see kernel.h).
#pragma once

#include <cstdint>

namespace sinew::kernel {

/// What neighbors at rest exert because of the deformation around each particle: the force on i is
/// the sum of (T_i + T_j) X over them, X to the neighbor at rest. By particle, row by row.
template <class Real>
using Thrust = Real* [9];

/// Volumes of the materials that keep them, U = K_v V0 w (J - 1)^2 / 2 per particle.
template <class Real>
struct Volumes {
  Real* stiffness;  ///< K_v V0 w; 0 where no volume is kept; null: nowhere
  Real* growth;     ///< J - 1
  Thrust<Real> thrust;
};

/// Rows of coefficients of an entry of the bonds.
struct FiberRows {
  std::uint32_t own;     ///< A^-1 t . X of the particles of the block, X to the neighbors
  std::uint32_t others;  ///< the same with A^-1 t of their neighbors
};

/// One fiber of every particle. As t is known at rest, what a fiber's deformation needs of F and
/// what its neighbors feel are weighted sums: F t = sum (A^-1 t . X_ij) (x_j - x_i), and the force
/// on i is sum (A_j^-1 t_j . X_ij) p_j + p_i sum (A_i^-1 t_i . X_ij), where p is the pull.
template <class Real>
struct FiberLayer {
  const std::uint32_t* first;  ///< slots of block k: [first[k], first[k + 1])
  const std::int32_t* muscle;  ///< one per slot
  const Real* strength;        ///< slots x block: times weight and volume; 0 for other muscles
  const std::uint8_t* near;    ///< one per block: whether a particle or a neighbor at rest has one
  const FiberRows* rows;       ///< one per entry of the bonds
  const Real* coefficients;    ///< rows x block; 0 where nothing is bonded
  const Real* own;             ///< one per particle: the sum of its own coefficients
  Real* pull[3];               ///< one per particle: a S w V0 F t / |F t|^2
};

/// Fibers of muscles.
template <class Real>
struct Fibers {
  const FiberLayer<Real>* layers;
  int count;          ///< number of layers; 0: there are no fibers
  const Real* level;  ///< one per muscle: its activation
};

}  // namespace sinew::kernel

// SPDX-License-Identifier: GPL-3.0-or-later
// How alike a packing is in all directions: Young's modulus of equal springs between particles that
// touch, for affine strains (C_ijkl ~ sum l^2 n_i n_j n_k n_l), along the softest and the stiffest
// direction.
//
//     DirectionalStiffness sum;
//     sum.add(bond);
//     const auto [least, most] = sum.modulus_range();
#pragma once

#include <Eigen/Core>
#include <array>

#include <sinew/core/vector.h>

namespace sinew {

class DirectionalStiffness {
 public:
  /// A spring between particles that far apart (any unit).
  void add(const Vec3& bond);

  /// Over the mean of all directions, to a few thousandths; 0 where springs leave a strain free.
  std::array<double, 2> modulus_range() const;

 private:
  Eigen::Matrix<double, 6, 6> sum_ = Eigen::Matrix<double, 6, 6>::Zero();  ///< Voigt's notation
};

}  // namespace sinew

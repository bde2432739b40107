// SPDX-License-Identifier: GPL-3.0-or-later
// Polynomials of a place, as groups move by them: affine ones have the terms 1, x, y, z; cubic ones
// those of the second and third degree as well, each product once, in the order of this loop nest:
//
//     1 x y z  xx xy xz yy yz zz  xxx xxy xxz xyy xyz xzz yyy yyz yzz zzz
//
//     const Vec3 value = value_at(coefficients, place);
#pragma once

#include <Eigen/Core>
#include <array>

#include <sinew/core/vector.h>
#include <sinew/kernel/kernel.h>

namespace sinew {

inline constexpr int affine_terms = kernel::affine_terms, square_terms = 10,
                     cubic_terms = kernel::cubic_terms;

using Terms = Eigen::Matrix<double, cubic_terms, 1>;
using SquareTerms = Eigen::Matrix<double, square_terms, 1>;
/// Coefficients of three values, one a column; those that a polynomial does not have are 0.
using Coefficients = Eigen::Matrix<double, cubic_terms, 3>;

/// The factors of each term: 0, 1 and 2 are x, y and z, 3 is 1.
inline constexpr std::array<std::array<int, 3>, cubic_terms> factors_of_terms = {
    {{3, 3, 3}, {0, 3, 3}, {1, 3, 3}, {2, 3, 3}, {0, 0, 3}, {0, 1, 3}, {0, 2, 3},
     {1, 1, 3}, {1, 2, 3}, {2, 2, 3}, {0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {0, 1, 1},
     {0, 1, 2}, {0, 2, 2}, {1, 1, 1}, {1, 1, 2}, {1, 2, 2}, {2, 2, 2}}};

inline SquareTerms square_terms_at(const Vec3& at) {
  const double x = at[0], y = at[1], z = at[2];
  SquareTerms terms;
  terms << 1, x, y, z, x * x, x * y, x * z, y * y, y * z, z * z;
  return terms;
}

inline Terms terms_at(const Vec3& at) {
  const double x = at[0], y = at[1], z = at[2];
  const double xx = x * x, xy = x * y, yy = y * y, yz = y * z, zz = z * z;
  Terms terms;
  terms << 1, x, y, z, xx, xy, x * z, yy, yz, zz, xx * x, xx * y, xx * z, x * yy, x * yz, x * zz,
      yy * y, yy * z, y * zz, zz * z;
  return terms;
}

/// The derivatives of all terms along x, y and z.
using Slopes = Eigen::Matrix<double, cubic_terms, 3>;
inline Slopes slopes_at(const Vec3& at) {
  const double x = at[0], y = at[1], z = at[2];
  const double xx = x * x, xy = x * y, xz = x * z, yy = y * y, yz = y * z, zz = z * z;
  Slopes slopes;
  slopes.col(0) << 0, 1, 0, 0, 2 * x, y, z, 0, 0, 0, 3 * xx, 2 * xy, 2 * xz, yy, yz, zz, 0, 0, 0, 0;
  slopes.col(1) << 0, 0, 1, 0, 0, x, 0, 2 * y, z, 0, 0, xx, 0, 2 * xy, xz, 0, 3 * yy, 2 * yz, zz, 0;
  slopes.col(2) << 0, 0, 0, 1, 0, 0, x, 0, y, 2 * z, 0, 0, xx, 0, xy, 2 * xz, 0, yy, 2 * yz, 3 * zz;
  return slopes;
}

inline Vec3 value_at(const Coefficients& of, const Vec3& at) {
  return of.transpose() * terms_at(at);
}

/// What terms of up to the third degree grow by from a place to another at a fixed difference, in
/// terms of up to the second degree there.
using Growth = Eigen::Matrix<double, cubic_terms, square_terms>;
Growth growth_over(const Vec3& difference);

}  // namespace sinew

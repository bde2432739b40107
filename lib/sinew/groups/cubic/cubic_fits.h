// SPDX-License-Identifier: GPL-3.0-or-later
// How well particles move by cubics of the place (polynomials.h), by least squares, from sums over
// them: over the particles of many cells, each with the motion of all of them, without a look at
// the particles.
//
//     const FitFrame frame(rest);
//     sums.add(terms_at(frame.at(X)), x - X, v);
//     if (const auto motion = cubic_motion(sums)) off = residual(sums_of_a_cell, *motion);
#pragma once

#include <Eigen/Core>
#include <optional>

#include <sinew/core/vector.h>
#include <sinew/groups/cubic/polynomials.h>

namespace sinew {

/// Frame in which places are about 1 from their middle in any direction.
class FitFrame {
 public:
  /// Fits places (m), at least one.
  explicit FitFrame(const Points& places);

  Vec3 at(const Vec3& place) const { return turn_ * (place - middle_); }

 private:
  Vec3 middle_ = Vec3::Zero();
  Mat3 turn_ = Mat3::Identity();  ///< 1/m
};

using TermProducts = Eigen::Matrix<double, cubic_terms, cubic_terms>;

/// Whether the sum of products of terms over places, in a frame of their own, tells all of them
/// apart: over a sheet of three layers, the cube of the place across it is a multiple of the place.
bool tells_apart(const TermProducts& products);

/// Over particles.
struct CubicSums {
  double n = 0, xx = 0, vv = 0;  ///< m^2, m^2/s^2
  TermProducts products = TermProducts::Zero();
  Coefficients x = Coefficients::Zero(), v = Coefficients::Zero();

  /// `displacement` in m, `velocity` in m/s.
  void add(const Terms& terms, const Vec3& displacement, const Vec3& velocity);
  CubicSums& operator+=(const CubicSums& other);
};

/// Displacements and velocities.
struct CubicMotion {
  Coefficients x, v;
};

/// Fits by least squares; none where terms cannot be told apart.
std::optional<CubicMotion> cubic_motion(const CubicSums& sums);

/// Mean squares of how far particles are from a motion: of their places (m^2) and velocities.
struct Residual {
  double x = 0, v = 0;
};
Residual residual(const CubicSums& of, const CubicMotion& motion);

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/groups/cubic/cubic_fits.h>

#include <Eigen/Cholesky>
#include <algorithm>

#include <sinew/core/decompositions.h>

namespace sinew {
namespace {

constexpr double flattest = 1e-6;   // mean square along an axis, over the largest
constexpr double min_apart = 1e-7;  // eigenvalue of products, over the largest

/// Returns the mean square of values less a polynomial, by sums of their squares and times terms.
double mean_square(double squares, const Coefficients& times_terms, const TermProducts& products,
                   const Coefficients& of, double n) {
  const double sum =
      squares - 2 * of.cwiseProduct(times_terms).sum() + of.cwiseProduct(products * of).sum();
  return std::max(sum, 0.0) / n;
}

}  // namespace

FitFrame::FitFrame(const Points& places) {
  const auto n = static_cast<double>(places.size());
  for (const Vec3& at : places) middle_ += at / n;
  Mat3 spread = Mat3::Zero();
  for (const Vec3& at : places) spread += (at - middle_) * (at - middle_).transpose() / n;
  const auto [values, axes] = principal_axes(spread);
  const double largest = values[2];
  if (!(largest > 0)) return;
  const Vec3 squares = values.cwiseMax(flattest * largest);
  turn_ = squares.cwiseSqrt().cwiseInverse().asDiagonal() * axes.transpose();
}

bool tells_apart(const TermProducts& products) {
  const Eigen::VectorXd values = eigenvalues_of_symmetric(products);
  return values[0] > min_apart * values[cubic_terms - 1];
}

void CubicSums::add(const Terms& terms, const Vec3& displacement, const Vec3& velocity) {
  n += 1, xx += displacement.squaredNorm(), vv += velocity.squaredNorm();
  products += terms * terms.transpose();
  x += terms * displacement.transpose();
  v += terms * velocity.transpose();
}

CubicSums& CubicSums::operator+=(const CubicSums& other) {
  n += other.n, xx += other.xx, vv += other.vv;
  products += other.products, x += other.x, v += other.v;
  return *this;
}

std::optional<CubicMotion> cubic_motion(const CubicSums& sums) {
  if (!tells_apart(sums.products)) return {};
  const Eigen::LDLT<TermProducts> solver(sums.products);
  return CubicMotion{solver.solve(sums.x), solver.solve(sums.v)};
}

Residual residual(const CubicSums& of, const CubicMotion& motion) {
  return {mean_square(of.xx, of.x, of.products, motion.x, of.n),
          mean_square(of.vv, of.v, of.products, motion.v, of.n)};
}

}  // namespace sinew

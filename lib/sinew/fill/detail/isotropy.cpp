// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/fill/detail/isotropy.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace sinew {
namespace {

constexpr int directions = 1000;

using Voigt = Eigen::Matrix<double, 6, 1>;

/// The products n_i n_j, which are a strain's weights in the stretch along n where shears are
/// engineering ones.
Voigt products(const Vec3& n) {
  return (Voigt() << n.x() * n.x(), n.y() * n.y(), n.z() * n.z(), n.y() * n.z(), n.z() * n.x(),
          n.x() * n.y())
      .finished();
}

/// Evenly over half the sphere, by the golden angle; the axes first.
Vec3 direction(int k) {
  if (k < 3) return Vec3::Unit(k);
  const double z = (k - 2.5) / (directions - 3), turn = k * pi * (3 - std::sqrt(5.0));
  const double across = std::sqrt(1 - z * z);
  return {across * std::cos(turn), across * std::sin(turn), z};
}

}  // namespace

void DirectionalStiffness::add(const Vec3& bond) {
  const double squared = bond.squaredNorm();
  if (squared == 0) return;
  const Voigt n = products(bond / std::sqrt(squared));
  sum_ += squared * n * n.transpose();
}

std::array<double, 2> DirectionalStiffness::modulus_range() const {
  const Eigen::FullPivLU<Eigen::Matrix<double, 6, 6>> solver(sum_);
  if (!solver.isInvertible()) return {0, 0};
  const Eigen::Matrix<double, 6, 6> compliance = solver.inverse();
  double least = HUGE_VAL, most = 0, total = 0;
  for (int k = 0; k < directions; ++k) {
    const Voigt n = products(direction(k));
    const double modulus = 1 / n.dot(compliance * n);
    least = std::min(least, modulus);
    most = std::max(most, modulus);
    total += modulus;
  }
  const double mean = total / directions;
  return {least / mean, most / mean};
}

}  // namespace sinew

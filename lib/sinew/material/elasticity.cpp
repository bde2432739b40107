// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/material/elasticity.h>

#include <algorithm>
#include <cmath>

namespace sinew {
namespace {

/// Compliances of a cubic crystal.
struct Compliances {
  double S11, S12, S44;

  explicit Compliances(const CubicConstants& C) {
    const double stretch = (C.C11 - C.C12) * (C.C11 + 2 * C.C12);
    S11 = (C.C11 + C.C12) / stretch;
    S12 = -C.C12 / stretch;
    S44 = 1 / C.C44;
  }
};

/// n1^2 n2^2 + n2^2 n3^2 + n3^2 n1^2 of a unit vector: 0 along a cube axis, 1/3 along a diagonal.
double off_axis(const Vec3& direction) {
  const Vec3 n2 = direction.normalized().cwiseAbs2();
  return n2[0] * n2[1] + n2[1] * n2[2] + n2[2] * n2[0];
}

}  // namespace

double CubicConstants::hill_shear_modulus() const {
  const double voigt = (C11 - C12 + 3 * C44) / 5;
  const double reuss = 5 * (C11 - C12) * C44 / (4 * C44 + 3 * (C11 - C12));
  return (voigt + reuss) / 2;
}

double CubicConstants::hill_young_modulus() const {
  const double K = bulk_modulus(), G = hill_shear_modulus();
  return 9 * K * G / (3 * K + G);
}

double CubicConstants::hill_poisson_ratio() const {
  const double K = bulk_modulus(), G = hill_shear_modulus();
  return (3 * K - 2 * G) / (2 * (3 * K + G));
}

double CubicConstants::young_modulus(const Vec3& direction) const {
  const Compliances S(*this);
  return 1 / (S.S11 - 2 * (S.S11 - S.S12 - S.S44 / 2) * off_axis(direction));
}

double CubicConstants::poisson_ratio(const Vec3& direction) const {
  // Under a tension along n the strains sum to S11 + 2 S12; the contraction across n is the rest.
  const Compliances S(*this);
  const double along = 1 / young_modulus(direction);
  return (along - (S.S11 + 2 * S.S12)) / (2 * along);
}

double volume_stiffness_for(double poisson_ratio, double second) {
  const CubicConstants bonds = fcc_constants({second, 0});
  const double shear = second > 0 ? bonds.hill_shear_modulus() : hill_shear;
  const double bulk = 2 * shear * (1 + poisson_ratio) / (3 * (1 - 2 * poisson_ratio));
  return std::max(0.0, bulk - bonds.bulk_modulus());
}

double lack_of_bending_stiffness(double planes, bool isotropic) {
  return std::min(1.0, (isotropic ? 1.0 : 2.5) / planes);
}

double highest_frequency_factor(const PackingStiffness& of) {
  // Lengthwise waves along a cube axis: 4 (1 - c) + s (1 - c^2) for a phase of cosine c from plane
  // to plane. Bonds alone are fastest where c = -1; those of second neighbors along a diagonal.
  const double s = std::numbers::sqrt2 * of.volume + 4 * of.second;
  const double bonds = 8 + 4 * of.second;
  return s > 2 ? std::max(bonds, 4 + s + 4 / s) : bonds;
}

}  // namespace sinew

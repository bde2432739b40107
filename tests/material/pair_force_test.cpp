// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/material/pair_force.h>

#include <gtest/gtest.h>
#include <algorithm>

#include "support/world.h"

namespace sinew::pair_force_test {

/// Different stiffness on both sides and a gap between 2r and a, to distinguish all terms.
constexpr PairForce gapped = {0.01, 3000, 50000, 0.022, 0.027};

PairForce standard() { return test::material_of(test::box_scene()).pair; }

TEST(PairForce, HasTheValuesOfEquation1) {
  const auto& [r, k1, k2, a, b] = gapped;
  EXPECT_DOUBLE_EQ(gapped.force(0), 4 * k1 * r * r);
  EXPECT_DOUBLE_EQ(gapped.force(r), 3 * k1 * r * r);
  EXPECT_EQ(gapped.force(2 * r), 0);
  EXPECT_EQ(gapped.force(0.021), 0);
  EXPECT_EQ(gapped.force(a), 0);
  EXPECT_DOUBLE_EQ(gapped.force((a + b) / 2), -k2 * (b - a) * (b - a) / 4);
  EXPECT_DOUBLE_EQ(gapped.force(0.023), -k2 * (0.023 - a) * (b - 0.023));
  EXPECT_EQ(gapped.force(b), 0);
  EXPECT_EQ(gapped.force(1), 0);
}

TEST(PairForce, AttractionIsStrongestHalfwayBetweenAAndB) {
  const double peak = gapped.force((gapped.a + gapped.b) / 2);
  for (double d = 0; d < 0.03; d += 1e-5) EXPECT_GE(gapped.force(d), peak * (1 + 1e-12));
}

TEST(PairForce, IsContinuousWithItsPotential) {
  for (const PairForce& pair : {gapped, standard()})
    for (const double d : {2 * pair.r, pair.a, pair.b}) {
      const double below = d * (1 - 1e-14), above = d * (1 + 1e-14);
      const double force_scale = pair.k1 * pair.r * pair.r, energy = force_scale * pair.r;
      EXPECT_NEAR(pair.force(below), pair.force(above), 1e-12 * force_scale);
      EXPECT_NEAR(pair.potential(below), pair.potential(above), 1e-12 * energy);
    }
}

TEST(PairForce, IsMinusTheSlopeOfThePotential) {
  for (const PairForce& pair : {gapped, standard()})
    for (double d = 1e-4; d < 0.03; d += 1.37e-5) {
      const double h = 1e-8;
      const double slope = (pair.potential(d + h) - pair.potential(d - h)) / (2 * h);
      EXPECT_NEAR(pair.force(d), -slope, 1e-5 * pair.k1 * pair.r * pair.r) << d;
    }
}

TEST(PairForce, PotentialVanishesBeyondBAndIsTheCohesionInTheGap) {
  const double cohesion = gapped.k2 * std::pow(gapped.b - gapped.a, 3) / 6;
  EXPECT_EQ(gapped.potential(gapped.b), 0);
  EXPECT_EQ(gapped.potential(1), 0);
  EXPECT_DOUBLE_EQ(gapped.potential(0.021), -cohesion);
  EXPECT_DOUBLE_EQ(gapped.potential(0), -cohesion + gapped.k1 / 3 * 16 * std::pow(gapped.r, 3));
}

double slope(const PairForce& pair, double from, double to) {
  return (pair.force(to) - pair.force(from)) / (to - from);
}

TEST(PairForce, HasTheStiffnessesOfTheModel) {
  for (const PairForce& pair : {gapped, standard()}) {
    const double h = 1e-8 * pair.r, contact = 4 * pair.k1 * pair.r;
    const double tension = pair.k2 * (pair.b - pair.a);
    EXPECT_NEAR(slope(pair, 2 * pair.r - h, 2 * pair.r), -contact, 1e-6 * contact);
    EXPECT_NEAR(slope(pair, pair.a, pair.a + h), -tension, 1e-6 * tension);
    EXPECT_NEAR(slope(pair, pair.b - h, pair.b), tension, 1e-6 * tension);
    EXPECT_DOUBLE_EQ(pair.contact_stiffness(), contact);
    EXPECT_DOUBLE_EQ(pair.tension_stiffness(), tension);
    EXPECT_DOUBLE_EQ(pair.lambda(), tension / contact);
  }
}

TEST(Material, DefaultsAreEquallyStiffOnBothSidesAndEndAt2Point6Radii) {
  const PairForce pair = standard();
  EXPECT_DOUBLE_EQ(pair.lambda(), 1);
  EXPECT_DOUBLE_EQ(pair.a, 0.02);
  EXPECT_DOUBLE_EQ(pair.b, 0.026);
}

TEST(Material, TakesConstantsInsteadOfModulusAndLambda) {
  Settings settings = test::box_scene();
  settings.material.k1 = 1234;
  settings.material.k2 = 567;
  const Material material = test::material_of(settings);
  EXPECT_EQ(material.pair.k1, 1234);
  EXPECT_EQ(material.pair.k2, 567);
  EXPECT_NEAR(material.young_modulus(), 2.70 * 1234, 0.001 * 2.70 * 1234);
}

TEST(Material, DampingIsRelativeToStiffnessAndMass) {
  const Material material = test::material_of(test::box_scene());
  const double k = material.pair.contact_stiffness();
  EXPECT_DOUBLE_EQ(material.mass, 1000 * 4 * std::sqrt(2.0) * 1e-6);
  EXPECT_DOUBLE_EQ(material.damping, 0.5 * std::sqrt(k * material.mass));
}

/// Energy per volume around a particle inside FCC, strained by `strain`, relative to rest.
double energy_density(const PairForce& pair, const Mat3& strain) {
  double sum = 0;
  for (const Vec3& site : test::fcc_ball(4, pair.r)) {
    if (site.norm() == 0) continue;
    const double d = ((Mat3::Identity() + strain) * site).norm();
    sum += (pair.potential(d) - pair.potential(site.norm())) / 2;
  }
  return sum / volume_per_particle(pair.r);
}

TEST(Material, LatticeHasTheCubicConstantsOfTheModel) {
  const PairForce pair = standard();
  const double unit = pair.contact_stiffness() / (2 * pair.r), e = 1e-5;  // k / d0
  const Mat3 along = Vec3(e, 0, 0).asDiagonal(), both = Vec3(e, e, 0).asDiagonal();
  Mat3 shear = Mat3::Zero();
  shear(0, 1) = shear(1, 0) = e / 2;
  const double c11 = 2 * energy_density(pair, along) / (e * e);
  const double c12 = energy_density(pair, both) / (e * e) - c11;
  const double c44 = 2 * energy_density(pair, shear) / (e * e);
  EXPECT_NEAR(c11, std::sqrt(2.0) * unit, 1e-3 * unit);
  EXPECT_NEAR(c12, unit / std::sqrt(2.0), 1e-3 * unit);
  EXPECT_NEAR(c44, unit / std::sqrt(2.0), 1e-3 * unit);
}

TEST(Material, YoungsModulusIsTheHillAverageOfTheLattice) {
  const PairForce pair = standard();
  const double unit = pair.contact_stiffness() / (2 * pair.r);
  const double c11 = std::sqrt(2.0), c12 = 1 / c11, c44 = c12;
  const double bulk = (c11 + 2 * c12) / 3, voigt = (c11 - c12 + 3 * c44) / 5;
  const double reuss = 5 * (c11 - c12) * c44 / (4 * c44 + 3 * (c11 - c12));
  const double shear = (voigt + reuss) / 2, young = 9 * bulk * shear / (3 * bulk + shear);
  EXPECT_NEAR(young * unit, 10e3, 10);
  EXPECT_NEAR((3 * bulk - 2 * shear) / (2 * (3 * bulk + shear)), hill_poisson, 1e-3);
}

}  // namespace sinew::pair_force_test

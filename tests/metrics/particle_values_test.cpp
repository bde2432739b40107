// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/pair_forces.h>
#include <sinew/metrics/particle_values.h>

#include <gtest/gtest.h>

#include "metrics/world.h"

namespace sinew::test::particle_values_test {

ParticleValues values_of(const Map& map, RestInput input = box_input()) {
  const RestBody body = rest_body(std::move(input));
  return particle_values(body, moved(body, map));
}

Map affine(const Mat3& F) {
  return [F](const Vec3& point) -> Vec3 { return F * point + Vec3(1, 2, 3); };
}

TEST(ParticleValues, AStretchHasItsHenckyStrainEverywhere) {
  const Mat3 F = turned(40, {1, 2, 3}) * Vec3(1.2, 1, 0.9).asDiagonal();
  const Vec3 H(std::log(1.2), 0, std::log(0.9));
  const double strain = std::sqrt(2.0 / 3 * (H.array() - H.mean()).square().sum());
  const ParticleValues values = values_of(affine(F));
  for (std::size_t i = 0; i < values.J.size(); ++i) {
    EXPECT_NEAR(values.J[i], 1.2 * 0.9, 1e-12);
    EXPECT_NEAR(values.strain[i], strain, 1e-12);
    EXPECT_NEAR(values.stretch[i], 1.2, 1e-12);
    EXPECT_NEAR(values.D2min[i], 0, 1e-24);
  }
}

TEST(ParticleValues, AShearIsTheStrainOfItsPrincipalStretches) {
  Mat3 F = Mat3::Identity();
  F(0, 2) = 0.5;
  // Simple shear g: stretches l, 1/l with l - 1/l = g, so ln l = asinh(g / 2).
  const double strain = 2 / std::sqrt(3.0) * std::asinh(0.25);
  for (const double value : values_of(affine(F)).strain) EXPECT_NEAR(value, strain, 1e-12);
}

TEST(ParticleValues, ARigidMotionStrainsNothing) {
  const ParticleValues values = values_of(affine(turned(77, {3, -1, 2})));
  for (std::size_t i = 0; i < values.J.size(); ++i) {
    EXPECT_NEAR(values.J[i], 1, 1e-12);
    EXPECT_NEAR(values.strain[i], 0, 1e-12);
    EXPECT_NEAR(values.D2min[i], 0, 1e-24);
  }
}

TEST(ParticleValues, AParticleThatLeavesItsCageIsNotAffine) {
  const RestBody body = rest_body(box_input());
  FrameState state = at_rest(body);
  std::size_t inner = 0;
  while (body.shape.neighbors.of(inner).size() < 12) ++inner;
  // All twelve seem to shift alike; as they lie in opposite pairs, no F explains any of it.
  state.positions[inner] += Vec3(0, 0, 0.1 * r);
  EXPECT_NEAR(particle_values(body, state).D2min[inner], 0.01 * r * r, 1e-16);
}

/// A linear spring of one unit around the distance at rest.
RestInput sprung() {
  RestInput input = box_input();
  static const ForceLaw law =
      law_without_bonds([](const Material&, double d) { return 2 * r - d; });
  obey(input, law);
  input.material.pair.b = 2.4 * r;
  return input;
}

TEST(ParticleValues, PressureHasNoVonMisesStressAndShearHas) {
  RestInput input = sprung();
  const RestBody body = rest_body(input);
  const auto inner = [&](const ParticleValues& values, auto test) {
    for (std::size_t i = 0; i < body.particles(); ++i)
      if (body.shape.neighbors.of(i).size() == 12) test(values.von_mises[i]);
  };
  const double unit = 1 / (2 * r);  // k / d0
  inner(values_of(affine(0.99 * Mat3::Identity()), input),
        [&](double stress) { EXPECT_NEAR(stress, 0, 1e-12 * unit); });
  // Pure shear e of the cube's axes: stress (C11 - C12) e, von Mises sqrt(3) times it.
  const double e = 1e-5;
  const double stress = std::sqrt(3.0) * e * (std::sqrt(2.0) - 1 / std::sqrt(2.0)) * unit;
  inner(values_of(affine(Vec3(1 + e, 1 - e, 1).asDiagonal()), input),
        [&](double value) { EXPECT_NEAR(value, stress, 1e-4 * stress); });
}

TEST(ParticleValues, AtRestEachHasItsNeighborsAndNoTurnover) {
  const RestBody body = rest_body(box_input());
  const ParticleValues values = particle_values(body, at_rest(body));
  for (std::size_t i = 0; i < body.particles(); ++i) {
    EXPECT_EQ(values.neighbors[i], double(body.shape.neighbors.of(i).size()));
    EXPECT_EQ(values.lost[i] + values.gained[i] + values.turnover[i], 0);
  }
}

TEST(ParticleValues, NeighborsAreThoseNearerThanTheRange) {
  const Points line{{0, 0, 0}, {0.4, 0, 0}, {0.8, 0, 0}, {0, 0.5, 0}};
  std::vector<Neighbor> found;
  const auto near = find_neighbors(line, CellGrid(line, 0.5), 0.5, 1, found);
  ASSERT_EQ(near.size(), 2u);
  for (const Neighbor& neighbor : near) {
    EXPECT_NE(neighbor.index % 2, 1u);
    EXPECT_NEAR(neighbor.squared, 0.16, 1e-15);
  }
}

}  // namespace sinew::test::particle_values_test

// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/pair_forces.h>

#include <gtest/gtest.h>

#include <sinew/core/particles.h>
#include "metrics/world.h"

namespace sinew::test::pair_forces_test {

Map scaled(double by) {
  return [by](const Vec3& point) -> Vec3 { return by * point; };
}

/// Springs of 1 N/m that change, and contacts of twice that.
RestInput changing() {
  static const ForceLaw law = law_of_springs(
      [](const Material&, double d) { return d < 2 * r ? 2 * (2 * r - d) : 0; },
      [](const Material&, double d) { return d < 2 * r ? (2 * r - d) * (2 * r - d) : 0; });
  RestInput input = box_input();
  obey(input, law);
  input.material.bond.breaking_strain = 100;
  return input;
}

/// Bonds of second neighbors of a quarter of that stiffness, and half the stiffness of all bonds.
RestInput weaker() {
  RestInput input = changing();
  input.material.bond.second = 0.25;
  const RestNeighbors near = rest_neighbors(input.positions, r, true);
  const NeighborLists second = second_neighbors(near);
  BondFactors factors;
  factors.first = {0};
  for (std::uint32_t i = 0; i < input.positions.size(); ++i) {
    factors.particle.push_back(i);
    for (const NeighborLists* lists : {&near.nearest, &second})
      for (const std::uint32_t j : lists->of(i)) {
        factors.neighbor.push_back(j);
        factors.factor.push_back(0.5);
      }
    factors.first.push_back(static_cast<std::uint32_t>(factors.neighbor.size()));
  }
  input.forces.factors = std::make_shared<const BondFactors>(std::move(factors));
  return input;
}

std::vector<double> times(double factor, std::vector<double> values) {
  for (double& value : values) value *= factor;
  return values;
}

/// The pressure of twelve forces (N) at a distance (m) from each particle.
double pressure(double force, double d) {
  return 12 * force * d / 3 / (2 * volume_per_particle(r));
}

void expect_pressure(const RestBody& body, const FrameState& state, double expected) {
  const std::vector<Mat3> found = kirchhoff_stresses(body, state);
  for (std::size_t i = 0; i < body.particles(); ++i)
    if (body.shape.neighbors.of(i).size() == 12) {
      EXPECT_LT((found[i] + expected * Mat3::Identity()).norm(), 1e-12 * pressure(r, r));
    }
}

TEST(PairForces, OfBondsThatChangeAreNotKnownWithoutTheirState) {
  const RestBody body = rest_body(changing());
  FrameState state = moved(body, scaled(1.1));
  EXPECT_FALSE(knows_forces(body, state));
  for (const Mat3& one : kirchhoff_stresses(body, state)) EXPECT_TRUE(one.array().isNaN().all());
  state.bond_rest = first_bond_rest(body);
  EXPECT_TRUE(knows_forces(body, state));
  expect_pressure(body, state, -pressure(0.1 * 2 * r, 1.1 * 2 * r));
}

TEST(PairForces, OfBondsThatCreptToTheirLengthAreNone) {
  const RestBody body = rest_body(changing());
  FrameState state = moved(body, scaled(1.1));
  state.bond_rest = times(1.1, first_bond_rest(body));
  expect_pressure(body, state, 0);
}

TEST(PairForces, OfBrokenBondsAreThoseOfContacts) {
  const RestBody body = rest_body(changing());
  FrameState apart = moved(body, scaled(1.1)), pressed = moved(body, scaled(0.9));
  apart.bond_rest = pressed.bond_rest = times(0, first_bond_rest(body));
  expect_pressure(body, apart, 0);
  expect_pressure(body, pressed, pressure(2 * 0.1 * 2 * r, 0.9 * 2 * r));
}

TEST(PairForces, VolumesOfSeveredParticlesAreNotKept) {
  RestInput input = changing();
  keep_volumes(input, 1000);
  const RestBody body = rest_body(input);
  FrameState state = moved(body, scaled(1.1));
  state.bond_rest = times(0, first_bond_rest(body));
  expect_pressure(body, state, 0);
}

/// Weaker bonds stand for less of the body, under the same stress.
TEST(PairForces, AreOverTheVolumeThatTheBondsMakeStiff) {
  const RestBody body = rest_body(weaker());
  FrameState state = moved(body, scaled(1.1));
  state.bond_rest = first_bond_rest(body);
  // Stress as of factors 1: twelve bonds, and six of a quarter at sqrt(2) times the distance.
  const double expected = pressure(0.1 * 2 * r, 1.1 * 2 * r) * (12 + 6 * 0.25 * 2) / 12;
  const std::vector<Mat3> found = kirchhoff_stresses(body, state);
  for (std::size_t i = 0; i < body.particles(); ++i)
    if (body.bonds_of(i) == 18) {
      EXPECT_LT((found[i] - expected * Mat3::Identity()).norm(), 1e-12 * expected);
    }
}

/// Energy (J) of so many pairs, half of each a particle's, over the volume of one inside.
double density(double pairs, double energy) { return pairs * energy / 2 / volume_per_particle(r); }

void expect_density(const RestBody& body, const FrameState& state, double expected) {
  const std::vector<double> found = energy_densities(body, state);
  for (std::size_t i = 0; i < body.particles(); ++i)
    if (body.shape.neighbors.of(i).size() == 12) {
      EXPECT_NEAR(found[i], expected, 1e-12 * density(12, r * r));
    }
}

TEST(EnergyDensity, IsThatOfBondsOfTheirPresentLengths) {
  const RestBody body = rest_body(changing());
  FrameState state = moved(body, scaled(1.1));
  state.bond_rest = times(1.05, first_bond_rest(body));
  expect_density(body, state, density(12, 0.05 * 2 * r * 0.05 * 2 * r / 2));
}

TEST(EnergyDensity, IsThatOfContactsWhereBondsBroke) {
  const RestBody body = rest_body(changing());
  FrameState state = moved(body, scaled(0.9));
  state.bond_rest = times(0, first_bond_rest(body));
  expect_density(body, state, density(12, 0.1 * 2 * r * 0.1 * 2 * r));
}

TEST(EnergyDensity, HasThatOfTheVolumeUntilABondBreaks) {
  RestInput input = changing();
  keep_volumes(input, 1000);
  const RestBody body = rest_body(input);
  FrameState state = moved(body, scaled(1.1));
  state.bond_rest = times(1.1, first_bond_rest(body));
  const double grown = 1.1 * 1.1 * 1.1 - 1;
  expect_density(body, state, 1000 * grown * grown / 2);
  state.bond_rest = times(0, first_bond_rest(body));
  expect_density(body, state, 0);
}

/// Weaker bonds stand for less of the body, with the same density.
TEST(EnergyDensity, IsOverTheVolumeThatTheBondsMakeStiff) {
  const RestBody body = rest_body(weaker());
  FrameState state = moved(body, scaled(1.1));
  state.bond_rest = first_bond_rest(body);
  const double one = 0.1 * 2 * r * 0.1 * 2 * r / 2;
  const double expected = density(12, one) + density(6, one * 2 / 4);
  const std::vector<double> found = energy_densities(body, state);
  for (std::size_t i = 0; i < body.particles(); ++i)
    if (body.bonds_of(i) == 18) {
      EXPECT_NEAR(found[i], expected, 1e-12 * expected);
    }
}

TEST(EnergyDensity, IsNotKnownWithoutEnergiesOrTheStateOfBonds) {
  RestInput relaxing = changing();  // what branches store is not in the lengths of bonds
  relaxing.material.bond.branches[0] = {0.5, 1};
  const RestBody stored = rest_body(changing()), forces_only = rest_body(relaxing);
  FrameState state = moved(stored, scaled(1.1));
  for (const double one : energy_densities(stored, state)) EXPECT_TRUE(std::isnan(one));
  state.bond_rest = first_bond_rest(stored);
  for (const double one : energy_densities(forces_only, state)) EXPECT_TRUE(std::isnan(one));
}

TEST(PairForces, OfMusclesAddTheirStress) {
  RestInput input = changing();
  input.forces.has_muscles = true;
  const RestBody body = rest_body(input);
  FrameState state = moved(body, scaled(1.1));
  state.bond_rest = times(1.1, first_bond_rest(body));
  EXPECT_FALSE(knows_forces(body, state));
  state.muscle_stress.assign(body.particles(), 7 * Mat3::Identity());
  expect_pressure(body, state, -7);
}

TEST(BondValues, HaveEachBondOnceWithItsStrainAndForce) {
  const RestBody body = rest_body(changing());
  FrameState state = moved(body, scaled(1.1));
  state.bond_rest = times(1.05, first_bond_rest(body));
  const BondValues values = bond_values(body, state);
  ASSERT_EQ(2 * values.ends.size(), body.shape.neighbors.neighbor.size());
  for (std::size_t k = 0; k < values.ends.size(); ++k) {
    EXPECT_LT(values.ends[k][0], values.ends[k][1]);
    EXPECT_NEAR(values.length[k], 2.2 * r, 1e-12 * r);
    EXPECT_NEAR(values.strain[k], 1.1 / 1.05 - 1, 1e-12);
    EXPECT_NEAR(values.force[k], 0.05 * 2 * r, 1e-12 * r);
    EXPECT_EQ(values.broken[k], 0);
  }
}

TEST(BondValues, OfBrokenOnesAreALengthWithoutAStrain) {
  RestInput paper = box_input();
  ForceLaw law = law_without_bonds([](const Material&, double d) { return 2 * r - d; });
  law.has_bonds = false;
  obey(paper, law);
  paper.material.pair.b = 2.15 * r;
  const RestBody flowing = rest_body(paper), bonded = rest_body(changing());
  FrameState torn = moved(bonded, scaled(1.1));
  torn.bond_rest = times(0, first_bond_rest(bonded));
  for (const BondValues& values :
       {bond_values(bonded, torn), bond_values(flowing, moved(flowing, scaled(1.1)))})
    for (std::size_t k = 0; k < values.ends.size(); ++k) {
      EXPECT_NEAR(values.length[k], 2.2 * r, 1e-12 * r);
      EXPECT_TRUE(std::isnan(values.strain[k]));
      EXPECT_EQ(values.force[k], 0);
      EXPECT_EQ(values.broken[k], 1);
    }
}

}  // namespace sinew::test::pair_forces_test

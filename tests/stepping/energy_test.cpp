// SPDX-License-Identifier: GPL-3.0-or-later
// The balance of energy: the work of the bones is stored or lost, and nothing else.
#include <gtest/gtest.h>

#include "support/world.h"

namespace sinew::energy_test {

constexpr double r = 0.01;

Settings bend_scene(Integrator integrator) {
  Settings settings = test::box_scene(25);
  settings.solver.integrator = integrator;
  settings.tracks = {test::track("upper", {test::bend_key(0, 0), test::bend_key(0.5, 60)})};
  return settings;
}

/// The part of the bones' work that is neither stored nor lost, relative to the work, after `time`.
double residual(const Settings& settings, double time) {
  Simulation simulation = test::make_simulation(settings, test::fcc_box(7, 7, 25, r));
  const double start = simulation.energies().stored();
  while (simulation.time() < time) simulation.step();
  const Energies end = simulation.energies();
  EXPECT_NE(end.work_of_bones, 0);
  EXPECT_GT(end.dissipation, 0);
  return (end.stored() - start - end.work_of_bones + end.dissipation) / end.work_of_bones;
}

TEST(Energy, BalanceClosesOverABend) {
  for (const Integrator integrator : {Integrator::symplectic_euler, Integrator::velocity_verlet})
    for (const double time : {0.25, 0.7})
      EXPECT_LT(std::abs(residual(bend_scene(integrator), time)), 0.005) << time;
}

TEST(Energy, BalanceClosesWithTwistAnchorsJointZoneAndGravity) {
  Settings twist = bend_scene(Integrator::symplectic_euler);
  twist.tracks = {test::track("upper", {test::twist_key(0, 0), test::twist_key(0.5, 60)})};
  twist.binding.joint_zone = 3;
  EXPECT_LT(std::abs(residual(twist, 0.6)), 0.005);
  Settings anchored = bend_scene(Integrator::symplectic_euler);
  anchored.binding.force = BoneForce::anchor;
  EXPECT_LT(std::abs(residual(anchored, 0.6)), 0.005);
  Settings heavy = bend_scene(Integrator::symplectic_euler);
  heavy.solver.gravity = {1, 0, -2};
  EXPECT_LT(std::abs(residual(heavy, 0.6)), 0.005);
}

TEST(Energy, BalanceClosesWhereABoneStretches) {
  Settings settings = bend_scene(Integrator::symplectic_euler);
  settings.tracks[0].keys[1].stretch = 1.2;
  EXPECT_LT(std::abs(residual(settings, 0.6)), 0.005);
}

TEST(Energy, BalanceClosesWhereHoldsYield) {
  for (const BoneForce form : {BoneForce::paper, BoneForce::anchor}) {
    Settings settings = bend_scene(Integrator::symplectic_euler);
    settings.binding.force = form;
    settings.binding.max_force = 0.02;
    settings.tracks[0].keys[1].stretch = 1.1;
    EXPECT_LT(std::abs(residual(settings, 0.6)), 0.005);
  }
}

TEST(Energy, BalanceClosesForEveryDampingForm) {
  for (const DampingForm form : {DampingForm::symmetric, DampingForm::central}) {
    Settings settings = bend_scene(Integrator::symplectic_euler);
    settings.material.damping_form = form;
    EXPECT_LT(std::abs(residual(settings, 0.6)), 0.005);
  }
}

TEST(Energy, ErrorOfTheBalanceFallsWithTheStep) {
  Settings coarse = bend_scene(Integrator::symplectic_euler), fine = coarse;
  fine.solver.time_step_factor = 0.1;
  EXPECT_LT(std::abs(residual(fine, 0.5)), 0.0005);
}

TEST(Energy, OfAFreeUndampedBodyIsKept) {
  Settings settings = test::unbound(test::box_scene(25));
  settings.material.damping = 0;
  settings.solver.time_step_factor = 0.1;
  const Points rest = test::fcc_box(7, 7, 15, r);
  const Material material = test::material_of(settings);
  const double limit = step_limit(Integrator::symplectic_euler, material, {});
  Simulation simulation =
      test::simulation_from(settings, rest, test::shaken(rest, material, 0, 0.05), 0.1 * limit);
  const Energies start = simulation.energies();
  for (int step = 0; step < 500; ++step) simulation.step();
  const Energies end = simulation.energies();
  EXPECT_NEAR(end.stored() - start.stored(), 0, 0.01 * start.kinetic);
  EXPECT_EQ(end.work_of_bones, 0);
  EXPECT_EQ(end.dissipation, 0);
}

TEST(Energy, OfAFreeDampedBodyIsInTheLedgerAtEveryMoment) {
  const Settings settings = test::unbound(test::box_scene(25));
  const Points rest = test::fcc_box(7, 7, 15, r);
  const Material material = test::material_of(settings);
  const double step = 0.1 * step_limit(Integrator::symplectic_euler, material, {});
  Simulation simulation =
      test::simulation_from(settings, rest, test::shaken(rest, material, 0, 0.05), step);
  const Energies start = simulation.energies();
  while (simulation.steps() < 50) {
    simulation.step();
    const Energies now = simulation.energies();
    ASSERT_NEAR(now.stored() + now.dissipation - start.stored() - start.dissipation, 0,
                0.003 * start.kinetic);
  }
  EXPECT_GT(simulation.energies().dissipation, 0.5 * start.kinetic);
}

TEST(Energy, AtRestIsTheCohesionOfAllBonds) {
  Simulation simulation = test::make_simulation(test::box_scene(25), test::fcc_box(5, 5, 9, r));
  const PairForce pair = simulation.body().material.pair;
  int neighbors = 0;
  for (const int count : simulation.forces().neighbors) neighbors += count;
  const double cohesion = pair.k2 * std::pow(pair.b - pair.a, 3) / 6;
  const Energies energies = simulation.energies();
  EXPECT_NEAR(energies.pair, -cohesion * neighbors / 2, 1e-10 * cohesion * neighbors);
  EXPECT_NEAR(energies.kinetic, 0, 1e-25);
  EXPECT_NEAR(energies.bone, 0, 1e-25);
  EXPECT_EQ(energies.gravity, 0);
}

}  // namespace sinew::energy_test

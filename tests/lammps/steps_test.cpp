// SPDX-License-Identifier: GPL-3.0-or-later
// LAMMPS takes the steps of the built-in engine, with every integrator and on any number of ranks.
#include "lammps_world.h"

namespace sinew::steps_test {

using test::Bar;

void advance(Simulation& simulation, int steps) {
  for (int i = 0; i < steps; ++i) simulation.step();
}

/// Largest distance between particles at both moments, in radii.
double largest_distance(const Particles& a, const Particles& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    most = std::max(most, (a.position(i) - b.position(i)).norm());
  return most / test::bar_radius;
}

/// Both engines go on from the same moment; it need not be the beginning.
void expect_equal_steps(const Bar& bar, int before, int steps, int ranks) {
  const double step = bar.step(0.3);
  Simulation simulation = bar.simulation(step);
  advance(simulation, before);
  Simulation there = bar.simulation(step);
  there.restore(simulation.save());
  const StepPlan plan(step);
  const test::OnLammps lammps(there, bar.motion(), bar.stepping(step), plan, steps, ranks);
  there.restore(lammps.state());
  advance(simulation, steps);
  EXPECT_EQ(there.steps(), simulation.steps());
  EXPECT_LE(largest_distance(there.particles(), simulation.particles()), 1e-9);
  const Energies found = there.energies(), expected = simulation.energies();
  EXPECT_NEAR(found.work_of_bones, expected.work_of_bones, 1e-9 * expected.kinetic);
  EXPECT_NEAR(found.dissipation, expected.dissipation, 1e-9 * expected.dissipation);
  EXPECT_NEAR(found.kinetic, expected.kinetic, 1e-9 * expected.kinetic);
  EXPECT_NEAR(found.work_of_world, expected.work_of_world, 1e-9 * expected.kinetic);
}

class StepsOnLammps : public testing::TestWithParam<Integrator> {};

TEST_P(StepsOnLammps, AreThoseOfTheBuiltInEngine) {
  Bar bar;
  bar.settings.solver.integrator = GetParam();
  bar.settings.binding.bone_damping = 2;
  expect_equal_steps(bar, 0, 200, 2);
  expect_equal_steps(bar, 10, 100, 1);
}

TEST_P(StepsOnLammps, OfBondsAreThoseOfTheBuiltInEngine) {
  Bar bar;
  bar.settings.solver.integrator = GetParam();
  bar.settings.binding.bone_damping = 2;
  bar.settings.material.model = MaterialModel::bonded;
  expect_equal_steps(bar, 0, 200, 2);
}

TEST_P(StepsOnLammps, OfVolumesAreThoseOfTheBuiltInEngine) {
  Bar bar;
  bar.settings.solver.integrator = GetParam();
  bar.settings.binding.bone_damping = 2;
  bar.settings.material.model = MaterialModel::bonded_volume;
  expect_equal_steps(bar, 0, 300, 2);
  expect_equal_steps(bar, 10, 100, 3);
}

TEST_P(StepsOnLammps, InSurroundingsAreThoseOfTheBuiltInEngine) {
  Bar bar;
  bar.settings.solver.integrator = GetParam();
  bar.settings.binding.bone_damping = 2;
  test::add_obstacles(bar.surroundings());
  test::add_fields(bar.surroundings());
  test::add_grips(bar.surroundings(), bar.rest.size());
  expect_equal_steps(bar, 0, 300, 2);
  expect_equal_steps(bar, 10, 100, 3);
}

INSTANTIATE_TEST_SUITE_P(Every, StepsOnLammps,
                         testing::Values(Integrator::symplectic_euler, Integrator::explicit_euler,
                                         Integrator::velocity_verlet));

}  // namespace sinew::steps_test

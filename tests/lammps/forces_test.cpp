// SPDX-License-Identifier: GPL-3.0-or-later
// LAMMPS computes the forces of the built-in engine, whatever the material and however many ranks.
#include "lammps_world.h"

namespace sinew::forces_test {

using test::Bar;

struct Choice {
  const char* name;
  std::function<void(Bar&)> choose;
};

std::ostream& operator<<(std::ostream& out, const Choice& choice) { return out << choice.name; }

double relative_error(const Points& found, const Points& expected) {
  double error = 0, largest = 1e-300;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    error = std::max(error, (found[i] - expected[i]).norm());
    largest = std::max(largest, expected[i].norm());
  }
  return error / largest;
}

void expect_equal_forces(const Bar& bar, int ranks) {
  const double step = bar.step(0.2);
  Simulation simulation = bar.simulation(step);
  const test::OnLammps lammps(simulation, bar.motion(), bar.stepping(step), StepPlan(step), 0,
                              ranks);
  const Forces found = lammps.forces(), &expected = simulation.forces();
  EXPECT_LE(relative_error(found.pair, expected.pair), 1e-12);
  EXPECT_LE(relative_error(found.damping, expected.damping), 1e-12);
  EXPECT_LE(relative_error(found.bone, expected.bone), 1e-12);
  if (bar.world) {
    EXPECT_LE(relative_error(found.world, expected.world), 1e-12);
  }
  EXPECT_EQ(found.neighbors, expected.neighbors);
}

class ForcesOnLammps : public testing::TestWithParam<Choice> {};

TEST_P(ForcesOnLammps, EqualTheBuiltInEngines) {
  Bar bar;
  GetParam().choose(bar);
  expect_equal_forces(bar, 2);
}

void initial_neighbors(Bar& bar) { bar.settings.material.cohesion = Cohesion::initial_neighbors; }
void bonded(Bar& bar) { bar.settings.material.model = MaterialModel::bonded; }
void bonded_volume(Bar& bar) {
  bar.settings.material.model = MaterialModel::bonded_volume;
  bar.shake = 0.2;
}
void twelve_bonds(Bar& bar) {
  bonded(bar);
  bar.settings.material.isotropic = false;
}
void damp(Bar& bar, DampingForm form) { bar.settings.material.damping_form = form; }

INSTANTIATE_TEST_SUITE_P(
    Every, ForcesOnLammps,
    testing::Values(
        Choice{"paper", [](Bar&) {}}, Choice{"initial_neighbors", initial_neighbors},
        Choice{"bonded", bonded}, Choice{"twelve_bonds", twelve_bonds},
        Choice{"bonded_volume", bonded_volume},
        Choice{"torn",
               [](Bar& bar) {
                 bonded(bar);
                 bar.shake = 0.8;
               }},
        Choice{"crowded", [](Bar& bar) { bar.shake = 0.8; }},
        Choice{"symmetric", [](Bar& bar) { damp(bar, DampingForm::symmetric); }},
        Choice{"central_of_bonds",
               [](Bar& bar) {
                 bonded(bar);
                 damp(bar, DampingForm::central);
               }},
        Choice{"joint_zone", [](Bar& bar) { bar.settings.binding.joint_zone = 2; }},
        Choice{"anchor", [](Bar& bar) { bar.settings.binding.force = BoneForce::anchor; }},
        Choice{"obstacles", [](Bar& bar) { test::add_obstacles(bar.surroundings()); }},
        Choice{"fields", [](Bar& bar) { test::add_fields(bar.surroundings()); }},
        Choice{"grips", [](Bar& bar) { test::add_grips(bar.surroundings(), bar.rest.size()); }},
        Choice{"core", [](Bar& bar) { bar.settings.binding.core_radius = 0.02; }}),
    [](const auto& choice) { return std::string(choice.param.name); });

TEST(RanksOfLammps, HaveObstaclesThatTouch) {
  Bar bar;
  test::add_obstacles(bar.surroundings());
  Simulation simulation = bar.simulation(bar.step(0.2));
  simulation.forces();
  for (const Reaction& on : simulation.reactions_of_obstacles()) EXPECT_GT(on.force.norm(), 0);
}

TEST(RanksOfLammps, FindTheSameForces) {
  for (const int ranks : {1, 4}) {
    Bar bar;
    bonded(bar);
    damp(bar, DampingForm::symmetric);
    expect_equal_forces(bar, ranks);
  }
}

/// Two particles in one place push each other apart along x.
TEST(RanksOfLammps, SeparateCoincidentParticles) {
  Bar bar;
  bar.rest = {Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(0.019, 0, 0)};
  bar.shake = 0;
  for (const int ranks : {1, 4}) expect_equal_forces(bar, ranks);  // more than there are particles
}

}  // namespace sinew::forces_test

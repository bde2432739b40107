// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies of parts that differ in density, stiffness and strength.
#include <sinew/material/local_strength.h>

#include <numeric>

#include "support/all_steppers.h"
#include "support/machine.h"

namespace sinew::local_material_test {

using namespace machine;

/// The upper half three times as heavy, twice as stiff, and hard to compress.
Machine of_two(MaterialModel model = MaterialModel::bonded_volume) {
  Machine machine(model);
  machine.settings.material.poisson_ratio = 0.3;
  LocalMaterialSettings upper{"upper", 2e4, {}, 3000};
  if (model == MaterialModel::bonded_volume) upper.poisson_ratio = 0.45;
  upper.part.region.low = Vec3(-1, -1, machine.rest.back().z() / 2);
  upper.part.region.high = Vec3(1, 1, 1);
  machine.settings.materials = {upper};
  return machine;
}

double mass_of_all(const Body& body) { return total_mass(body, body.material.mass); }

TEST(LocalDensity, IsThatOfItsPart) {
  const Body body = of_two().body();
  double expected = 0;
  for (const Vec3& p : body.rest)
    expected += body.material.mass * (p.z() >= body.rest.back().z() / 2 ? 3 : 1);
  EXPECT_NEAR(mass_of_all(body), expected, 1e-12 * expected);
}

TEST(LocalDensity, WeighsOnWhatHoldsIt) {
  Machine machine = of_two();
  machine.world.supports = {{"clamp", machine.bottom()}};
  machine.settings.solver.gravity = {0.3, 0, -1};
  Simulation simulation = machine.at_rest();
  const Vec3 weight = mass_of_all(simulation.body()) * machine.settings.solver.gravity;
  EXPECT_LT((sum_of(simulation.support_reactions()) + weight).norm(), 1e-6 * weight.norm());
}

/// Both steppers and precisions keep momentum and energy.
TEST(LocalDensity, KeepsMomentumAndEnergy) {
  for (const bool cells : {false, true})
    for (const Precision precision : test::precisions) {
      if (cells && precision == Precision::binary32) continue;
      Machine machine = of_two();
      machine.settings.solver.precision = precision;
      if (cells) machine.settings = test::with_cells(machine.settings);
      const Body body = machine.body();
      const double step = 0.1 * step_limit(Integrator::symplectic_euler, body);
      Simulation simulation(body, {}, test::shaken(machine.rest, body.material, 0.02 * r, 0.05),
                            stepping_of(machine.settings.solver, step));
      const auto momentum = [&] {
        Vec3 sum = Vec3::Zero();
        for (std::size_t i = 0; i < machine.rest.size(); ++i)
          sum += mass_of(body, i, body.material.mass) * simulation.particles().velocity(i);
        return sum;
      };
      const Vec3 before = momentum();
      const double start = simulation.energies().stored();
      while (simulation.steps() < 800) simulation.step();
      const double scale = mass_of_all(body) * 0.05, rounding = cells ? 1e-12 : 1e-5;
      EXPECT_LT((momentum() - before).norm(), rounding * scale);
      const Energies end = simulation.energies();
      EXPECT_GT(end.dissipation, 0.2 * start);
      EXPECT_NEAR(end.stored() + end.dissipation, start, 0.002 * start);
    }
}

TEST(LocalStrength, BreaksWhereItIsWeak) {
  Machine machine(MaterialModel::bonded, 15);
  LocalMaterialSettings weak{"weak"};
  weak.breaking_strain = 0.02;
  const double middle = machine.rest.back().z() / 2;
  weak.part.region.low = Vec3(-1, -1, middle - 1.5 * r);
  weak.part.region.high = Vec3(1, 1, middle + 1.5 * r);
  machine.settings.materials = {weak};
  const Vec3 pivot(0, 0, machine.rest.back().z());
  machine.world.supports = {
      {"clamp", machine.bottom()},
      {"grip", machine.top(), {true, true, true}, moving(pivot, {0, 0, 0.05}), pivot}};
  Simulation simulation = machine.after(0.25);
  const std::vector<std::int32_t> broken = simulation.broken_bonds();
  EXPECT_GT(std::accumulate(broken.begin(), broken.end(), 0), 20);
  for (std::size_t i = 0; i < broken.size(); ++i)
    EXPECT_TRUE(broken[i] == 0 || std::abs(machine.rest[i].z() - middle) < 4 * r) << i;
}

}  // namespace sinew::local_material_test

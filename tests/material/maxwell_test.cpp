// SPDX-License-Identifier: GPL-3.0-or-later
// Bonds with branches of Maxwell's: bodies relax, creep and dissipate as the generalized Maxwell
// solid does.
#include <sinew/material/maxwell.h>

#include <sinew/body/solid.h>

#include <numbers>

#include "support/all_steppers.h"
#include "support/machine.h"

namespace sinew::maxwell_test {

using namespace machine;

constexpr double pi = std::numbers::pi;

void relax(Machine& machine, std::vector<double> ratios, std::vector<double> times) {
  machine.settings.material.relaxation_shares = std::move(ratios);
  machine.settings.material.relaxation_times = std::move(times);
}

/// A grip above moves along z by that, m.
Machine gripped(const std::function<double(double)>& displacement) {
  Machine machine;
  const Vec3 pivot(0, 0, machine.rest.back().z());
  const auto motion = [=](double time, const Pose&) {
    constexpr double h = 1e-5;
    const double rate = (displacement(time + h) - displacement(time - h)) / (2 * h);
    return ObstaclePose{
        {pivot + Vec3(0, 0, displacement(time)), Mat3::Identity()}, {0, 0, rate}, Vec3::Zero()};
  };
  machine.world.supports = {{"clamp", machine.bottom()},
                            {"grip", machine.top(), {true, true, true}, motion, pivot}};
  return machine;
}

double pull_of(Simulation& simulation) { return simulation.support_reactions()[1].force.z(); }

/// Its stiffness against a pull while nothing has relaxed, N/m.
double stiffness_at_once() {
  constexpr double by = 1e-5;
  Simulation simulation = gripped([](double) { return by; }).at_rest();
  return pull_of(simulation) / by;
}

TEST(BranchClock, RelaxesByTheWholeTimeThatPasses) {
  for (const double step : {1e-6, 1e-3, 0.3}) {
    BranchClock clock(0.1);
    double remaining = 1, time = 0, least = 1;
    while (time < 1) {
      const double flows = clock.flows(step);
      if (flows > 0) least = std::min(least, flows);
      remaining *= 1 - flows;
      time += step;
      clock.advance(step);
      EXPECT_NEAR(clock.ahead() + time, -0.1 * std::log(remaining), 1e-9);
      EXPECT_LE(std::abs(clock.ahead()), (std::max(step, 0.1 / 256) + step) / 2);
    }
    EXPECT_GT(least, 1.0 / 520);
  }
}

TEST(Branches, OfAHeldBodyRelaxByTheSumOfTheirExponentials) {
  MaterialOptions options;
  options.model = MaterialModel::bonded;
  options.relaxation_shares = {0.3, 0.2};
  options.relaxation_times = {0.01, 0.4};
  const Points rest = test::fcc_box(5, 5, 5, r);
  const Material material = make_material(options, {r, 1000 * volume_per_particle(r)});
  Solid solid(material, rest);
  const Particles particles =
      particles_at(test::affine(rest, 1.05 * Mat3::Identity()), r, material.mass);
  Forces forces;
  solid.forces(particles, forces);
  const Points before = forces.pair;
  double energy = solid.energy(particles);
  for (int step = 0; step < 500; ++step) {
    solid.branches().begin(1e-3);
    const double lost = solid.evolve(particles, 1e-3);
    solid.branches().advance(1e-3);
    const double now = solid.energy(particles);
    ASSERT_NEAR(energy - now, lost, 1e-12 * energy);
    ASSERT_GE(lost, 0);
    energy = now;
  }
  solid.branches().begin(1e-3);
  solid.forces(particles, forces);
  const double left = 0.5 + 0.3 * std::exp(-0.5 / 0.01) + 0.2 * std::exp(-0.5 / 0.4);
  for (std::size_t i = 0; i < rest.size(); ++i)
    EXPECT_LT((forces.pair[i] - left * before[i]).norm(), 2e-3 * before[i].norm() + 1e-15);
}

/// Pulled within 50 ms, then held.
TEST(Branches, OfAStretchedBarRelaxAsPronySays) {
  constexpr double by = 1e-4, ramp = 0.05, tau[2] = {0.2, 1}, ratio[2] = {0.3, 0.25};
  const double stiffness = stiffness_at_once();
  for (const Precision precision : test::precisions) {
    Machine machine = gripped([](double t) { return by * std::clamp(t / ramp, 0.0, 1.0); });
    machine.settings.solver.precision = precision;
    relax(machine, {ratio[0], ratio[1]}, {tau[0], tau[1]});
    machine.settings.material.damping = 30;
    Simulation simulation = machine.begin();
    for (const double time : {0.3, 0.6, 1.5}) {
      while (simulation.time() < time) simulation.step();
      double left = 1 - ratio[0] - ratio[1];
      for (int b = 0; b < 2; ++b)
        left += ratio[b] * tau[b] / ramp *
                (std::exp(-(simulation.time() - ramp) / tau[b]) -
                 std::exp(-simulation.time() / tau[b]));
      EXPECT_NEAR(pull_of(simulation) / (stiffness * by), left, 0.01 * left) << time;
    }
  }
}

/// Creep of a load that grows within T: u(t) = F / K (1 - g (e^(-w (t - T)) - e^(-w t)) / (w T)) /
/// (1 - g), w = (1 - g) / tau.
TEST(Branches, OfALoadedBarCreepAsTheStandardLinearSolid) {
  constexpr double ratio = 0.5, tau = 0.5, ramp = 0.25;
  const auto height_of = [](Simulation& simulation, const Machine& machine) {
    double sum = 0;
    for (const std::uint32_t id : machine.top())
      sum += simulation.particles().z[id] - machine.rest[id].z();
    return sum;
  };
  Machine machine;
  machine.world.supports = {{"clamp", machine.bottom()}};
  machine.world.loads = {machine.pull(machine.top(), {0, 0, 0.001})};
  Simulation at_rest = machine.at_rest();
  const double at_once = height_of(at_rest, machine);
  relax(machine, {ratio}, {tau});
  machine.settings.material.damping = 20;
  machine.world.loads[0].scale = {{0, ramp}, {0, 1}};
  Simulation simulation = machine.begin();
  for (const double time : {1.0, 2.0, 3.0}) {
    while (simulation.time() < time) simulation.step();
    const double left = 1 - ratio, w = left / tau, t = simulation.time();
    const double expected =
        (1 - ratio * (std::exp(-w * (t - ramp)) - std::exp(-w * t)) / (w * ramp)) / left;
    EXPECT_NEAR(height_of(simulation, machine) / at_once, expected, 0.01 * expected) << time;
  }
  machine.world.loads[0].scale = {};
  Simulation long_term = machine.at_rest();
  EXPECT_NEAR(height_of(long_term, machine) / at_once, 1 / (1 - ratio), 1e-3);
}

/// pi K A^2 g w tau / (1 + (w tau)^2) in a cycle.
TEST(Branches, DissipateByTheLossModulus) {
  constexpr double amplitude = 2e-4, w = 2 * pi, ratio = 0.4;
  const double stiffness = stiffness_at_once();
  for (const double tau : {0.02, 0.15}) {
    Machine machine = gripped([](double t) { return amplitude * (1 - std::cos(w * t)); });
    relax(machine, {ratio}, {tau});
    machine.settings.material.damping = 0;
    Simulation simulation = machine.begin();
    double dissipated = 0;
    for (const int cycles : {2, 5}) {
      while (simulation.time() < cycles) simulation.step();
      dissipated = simulation.energies().dissipation - dissipated;
    }
    const double loss = ratio * w * tau / (1 + w * w * tau * tau);
    const double expected = 3 * pi * stiffness * amplitude * amplitude * loss;
    EXPECT_NEAR(dissipated, expected, 0.03 * expected) << tau;
    const Energies end = simulation.energies();
    EXPECT_NEAR(end.stored() + end.dissipation, end.work(), 0.002 * end.dissipation);
  }
}

TEST(Branches, OfABodyBroughtToRestHaveRelaxed) {
  Machine machine;
  machine.world.supports = {{"clamp", machine.bottom()}};
  machine.world.loads = {machine.pull(machine.top(), {0.01, 0.004, 0.02})};
  Simulation stiff = machine.at_rest({1, 1, 1e-8});
  relax(machine, {0.25, 0.25}, {1, 100});
  machine.world.loads = {machine.pull(machine.top(), {0.005, 0.002, 0.01})};
  Simulation relaxed = machine.at_rest({1, 1, 1e-8});
  EXPECT_LT(test::largest_distance(stiff.particles(), relaxed.particles()), 1e-5 * r);
}

/// What a bond's free length leaves as its force is what the particles feel.
TEST(Branches, AreInTheRestOfBonds) {
  for (const bool cells : {false, true}) {
    Machine machine = gripped([](double t) { return 2e-3 * std::min(t, 1.0); });
    relax(machine, {0.5}, {0.1});
    machine.settings.material.isotropic = false;
    if (cells) machine.settings = test::with_cells(machine.settings);
    Simulation simulation = machine.begin();
    while (simulation.time() < 0.3) simulation.step();
    const NeighborLists nearest = neighbors_within(machine.rest, rest_neighbor_range(r));
    const std::vector<double> rest = simulation.rest_of_bonds(nearest, {});
    const Particles& now = simulation.particles();
    const double k = simulation.body().material.bond.stiffness;
    for (std::size_t i = 0; i < machine.rest.size(); ++i) {
      Vec3 force = Vec3::Zero();
      for (std::uint32_t e = nearest.first[i]; e < nearest.first[i + 1]; ++e) {
        const Vec3 to = now.position(nearest.neighbor[e]) - now.position(i);
        force += k * (to.norm() - rest[e]) * to.normalized();
      }
      EXPECT_LT((simulation.forces().pair[i] - force).norm(), 2e-3 * k * 1e-4);
    }
  }
}

}  // namespace sinew::maxwell_test

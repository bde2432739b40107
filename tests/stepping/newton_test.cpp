// SPDX-License-Identifier: GPL-3.0-or-later
// Equilibria of slender bodies by Newton's method: where a relaxation comes to rest, in a few
// iterations, however far the load leads, and never on a branch from which the body would buckle
// without a word.

#include <sinew/core/hash.h>
#include <sinew/stepping/equilibrium.h>

#include "support/all_steppers.h"
#include "support/expect_error.h"
#include "support/machine.h"

namespace sinew::newton_test {

using namespace machine;
using enum MaterialModel;

LoadSteps by(StaticSolver solver, int moments = 2) {
  LoadSteps steps{1, moments, 1e-8, 400'000, std::vector<int>(moments - 1, 300), 300};
  steps.solver = solver;
  return steps;
}

/// A bar of 31 layers under a force at its end and its own weight.
Machine cantilever(MaterialModel model) {
  Machine machine(model, 31);
  machine.world.supports = {{"clamp", machine.bottom()}};
  machine.world.loads = {machine.pull(machine.top(), {0.002, 0.001, 0.005})};
  machine.settings.solver.gravity = {0.03, 0, -0.1};
  return machine;
}

/// A bar of so many layers, whose upper end moves and turns within a second.
Machine gripped(int layers, const Vec3& velocity, const Vec3& spin) {
  Machine machine(bonded, layers);
  const Vec3 pivot(0, 0, machine.rest.back().z());
  machine.world.supports = {
      {"clamp", machine.bottom()},
      {"grip", machine.top(), {true, true, true}, moving(pivot, velocity, spin), pivot}};
  return machine;
}

std::uint64_t hash_of(const Particles& particles) {
  Hash hash;
  for (const auto* axis : {&particles.x, &particles.y, &particles.z})
    hash.add(axis->data(), axis->size() * sizeof(double));
  return hash.value();
}

TEST(Newton, EndsWhereARelaxationDoes) {
  for (const MaterialModel model : {bonded, bonded_volume}) {
    const Machine machine = cantilever(model);
    const Simulation newton = machine.at_rest(by(StaticSolver::newton)),
                     relaxed = machine.at_rest(by(StaticSolver::relaxation));
    EXPECT_LT(test::largest_distance(newton.particles(), relaxed.particles()), 1e-4 * r);
    EXPECT_GT(test::largest_distance(newton.particles(), particles_at(machine.rest, r, 1)), r);
    EXPECT_LE(newton.relaxation()->last().residual, 1e-8);
    EXPECT_LT(newton.steps(), 20);
    EXPECT_GT(relaxed.steps(), 1000);
  }
}

TEST(Newton, ConvergesQuadratically) {
  const Machine machine = cantilever(bonded);
  Simulation simulation = machine.relaxing(by(StaticSolver::newton, 1));
  std::vector<double> residuals;
  while (!simulation.relaxation()->done()) {
    simulation.step();
    residuals.push_back(simulation.relaxation()->residual());
  }
  ASSERT_GT(residuals.size(), 3u);
  const double last = residuals.back(), before = residuals[residuals.size() - 2],
               first = residuals[residuals.size() - 3];
  EXPECT_GT(std::log(last) / std::log(before), 1.5) << first << ' ' << before << ' ' << last;
}

TEST(Newton, OneFarLoadLeadsWhereManySmallOnesDo) {
  const Machine machine = gripped(21, {0, 0, -0.01}, {1.2, 0, 0});
  LoadSteps slowly = by(StaticSolver::newton, 11);
  slowly.interval = 0.1;
  const Simulation at_once = machine.at_rest(by(StaticSolver::newton)),
                   in_steps = machine.at_rest(slowly);
  EXPECT_LT(test::largest_distance(at_once.particles(), in_steps.particles()), 1e-6 * r);
  EXPECT_GT(at_once.relaxation()->last().increments, 1);
  EXPECT_EQ(at_once.relaxation()->last().unstable, 0);
}

/// A bar that is clamped at both ends buckles at a strain of (2 pi)^2 I / (A L^2).
TEST(Newton, SaysWhereABodyBuckles) {
  constexpr int layers = 61, across = 5;
  const double critical = 4 * pi * pi / 12 * std::pow(double{across} / (layers - 1), 2);
  for (const double times : {0.6, 1.5}) {
    const double length = (layers - 1) * half_plane_spacing(r);
    const Machine machine = gripped(layers, {0, 0, -times * critical * length}, Vec3::Zero());
    EXPECT_EQ(machine.at_rest(by(StaticSolver::newton)).relaxation()->last().unstable > 0,
              times > 1);
  }
}

/// Euler's load of a column that is clamped at its foot is pi^2 E I / (4 L^2), and a small force to
/// the side moves its end by L^3 / (3 E I) for each newton.
TEST(Newton, TellsTheLoadUnderWhichAColumnBuckles) {
  Machine machine(bonded, 41);
  machine.world.supports = {{"clamp", machine.bottom()}};
  const std::vector<std::uint32_t> top = machine.top();
  constexpr double to_the_side = 1e-4;
  machine.world.loads = {machine.pull(top, {to_the_side, 0, 0})};
  LoadSteps gently = by(StaticSolver::newton, 1);
  gently.residual = 1e-5;
  const Simulation bent = machine.at_rest(gently);
  const double moved = positions_by_id(bent.particles())[top[0]].x() - machine.rest[top[0]].x(),
               critical = pi * pi / 12 * to_the_side / moved * machine.rest.back().z();
  const double pressed = 1.5 * critical;
  machine.world.loads = {machine.pull(top, {0, 0, -pressed})};
  machine.world.loads[0].scale = {{0, 1}, {0, 1}};
  LoadSteps steps = by(StaticSolver::newton, 11);
  steps.interval = 0.1;
  const Simulation column = machine.at_rest(steps);
  ASSERT_TRUE(column.relaxation()->buckled());
  const auto [before, after] = *column.relaxation()->buckled();
  EXPECT_NEAR(pressed * (before + after) / 2, critical, 0.05 * critical);
  EXPECT_LT(after - before, 0.1 / 15);
}

TEST(Newton, GoesOnWithTheSameBitsWhereverItIsResumed) {
  const Machine machine = gripped(13, {0, 0, -0.01}, {1, 0, 0});
  const Simulation whole = machine.at_rest(by(StaticSolver::newton));
  for (const std::int64_t at : {std::int64_t{1}, whole.steps() / 2, whole.steps() - 1}) {
    Simulation first = machine.relaxing(by(StaticSolver::newton));
    for (std::int64_t k = 0; k < at; ++k) first.step();
    Simulation second = machine.relaxing(by(StaticSolver::newton));
    second.restore(first.save());
    while (!second.relaxation()->done()) second.step();
    EXPECT_EQ(hash_of(second.particles()), hash_of(whole.particles())) << at;
  }
}

TEST(Newton, SaysWhereItDoesNotApply) {
  const auto why = [](const Machine& machine) {
    return why_not_newton(undamped(machine.body()), stepping_of(machine.settings.solver, 1e-3));
  };
  EXPECT_EQ(why(cantilever(bonded)), "");
  EXPECT_EQ(why(cantilever(bonded_volume)), "");
  EXPECT_NE(why(cantilever(paper)), "");
  Machine single = cantilever(bonded);
  single.settings.solver.precision = Precision::binary32;
  EXPECT_NE(why(single), "");
  Machine creeping = cantilever(bonded);
  creeping.settings.material.yield_strain = 0.1;
  EXPECT_NE(why(creeping), "");
}

/// The number of iterations of a relaxation, within a factor of two, by shape alone.
TEST(Newton, ForeseesHowLongARelaxationTakes) {
  for (const int layers : {31, 61}) {
    Machine machine(bonded, layers);
    machine.world.supports = {{"clamp", machine.bottom()}};
    machine.world.loads = {machine.pull(machine.top(), {0.001, 0, 0})};
    LoadSteps steps = by(StaticSolver::relaxation, 1);
    steps.residual = 1e-6;
    const double foreseen = relaxation_cost(machine.body(), steps.residual).iterations,
                 made = static_cast<double>(machine.at_rest(steps).steps());
    EXPECT_LT(std::abs(std::log2(made / foreseen)), 1) << made << " of " << foreseen;
  }
}

}  // namespace sinew::newton_test

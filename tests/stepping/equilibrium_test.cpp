// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies brought to rest: in equilibrium with what loads and holds them, as a motion that is damped
// comes to be, and the same bits however a relaxation is run.
#include <sinew/stepping/equilibrium.h>

#include <functional>
#include <limits>

#include <sinew/core/hash.h>
#include <sinew/core/parallel.h>

#include "support/all_steppers.h"
#include "support/expect_error.h"
#include "support/machine.h"

namespace sinew::equilibrium_test {

using namespace machine;
using enum MaterialModel;

/// A cantilever under a force at its end and its own weight.
Machine cantilever(MaterialModel model = bonded, int height = 9) {
  Machine machine(model, height);
  machine.world.supports = {{"clamp", machine.bottom()}};
  machine.world.loads = {machine.pull(machine.top(), {0.02, 0.01, 0.05})};
  machine.settings.solver.gravity = {0.3, 0, -1};
  return machine;
}

/// A grip above pulls by 2 mm and turns by half a radian within a second.
Machine gripped(MaterialModel model = bonded) {
  Machine machine(model);
  const Vec3 pivot(0, 0, machine.rest.back().z());
  machine.world.supports = {{"clamp", machine.bottom()},
                            {"grip",
                             machine.top(),
                             {true, true, true},
                             moving(pivot, {0, 0, 0.002}, {0, 0, 0.5}),
                             pivot}};
  return machine;
}

LoadSteps two_moments() { return {1, 2, 1e-6, 200'000, {50}}; }

std::uint64_t hash_of(const Particles& particles) {
  Hash hash;
  for (const auto* axis : {&particles.x, &particles.y, &particles.z})
    hash.add(axis->data(), axis->size() * sizeof(double));
  return hash.value();
}

TEST(Relaxation, ReactionsBalanceLoadsAndWeight) {
  for (const MaterialModel model : {paper, bonded, bonded_volume}) {
    const Machine machine = cantilever(model);
    Simulation simulation = machine.at_rest();
    const Vec3 reaction = sum_of(simulation.support_reactions()),
               loads = sum_of(simulation.load_reactions());
    const double largest = std::max({reaction.norm(), loads.norm(), machine.weight().norm()});
    EXPECT_LT((reaction + loads + machine.weight()).norm(), 1e-6 * largest);
    EXPECT_LE(simulation.relaxation()->last().residual, 1e-6);
    EXPECT_EQ(test::largest_speed(simulation.particles()), 0);
  }
}

TEST(Relaxation, ReactionsOfGripsBalance) {
  for (const MaterialModel model : {paper, bonded, bonded_volume}) {
    const Machine machine = gripped(model);
    Simulation simulation = machine.at_rest(two_moments());
    EXPECT_EQ(simulation.time(), 1);
    const std::vector<Reaction> grips = simulation.support_reactions();
    EXPECT_LT(sum_of(grips).norm(), 1e-6 * grips[0].force.norm());
    const Vec3 moment = moment_of(grips, {Vec3::Zero(), {0, 0, machine.rest.back().z() + 0.002}});
    EXPECT_LT(moment.norm(), 1e-6 * grips[0].moment.norm());
  }
}

TEST(Relaxation, EndsWhereADampedMotionDoes) {
  Machine machine = cantilever();
  const Simulation relaxed = machine.at_rest({1, 1, 1e-8});
  machine.world.drag.rate = 15;
  const Simulation damped = machine.after(6);
  EXPECT_LT(test::largest_distance(relaxed.particles(), damped.particles()), 1e-6 * r);
  EXPECT_GT(test::largest_distance(relaxed.particles(), particles_at(machine.rest, r, 1)), 0.1 * r);
}

/// Under a load that rounding of places there would hide.
TEST(Relaxation, FarFromTheOriginIsThatAtIt) {
  const auto bent = [](const Vec3& at) {
    Machine machine = cantilever();
    machine.settings.solver.gravity.setZero();
    machine.world.loads = {machine.pull(machine.top(), {2e-5, 1e-5, 5e-5})};
    for (Vec3& place : machine.rest) place += at;
    machine.world.supports[0].pivot = machine.world.loads[0].pivot = at;
    return machine.at_rest();
  };
  const Vec3 far(std::ldexp(0.25, 24), 0, 0);
  Simulation here = bent(Vec3::Zero()), there = bent(far);
  EXPECT_LE(there.relaxation()->last().residual, 1e-6);
  const Vec3 reaction = sum_of(here.support_reactions());
  EXPECT_LT((sum_of(there.support_reactions()) - reaction).norm(), 1e-3 * reaction.norm());
  const Points near = positions_of(here.particles()), away = positions_of(there.particles());
  for (std::size_t i = 0; i < near.size(); ++i) EXPECT_LT((away[i] - far - near[i]).norm(), 1e-8);
}

/// A bar of 45 layers, pressed by this fraction of its length within a second.
Machine pressed(double fraction) {
  Machine machine(bonded);
  machine.rest = test::fcc_box(9, 9, 45, r);
  const Vec3 pivot(0, 0, machine.rest.back().z());
  machine.world.supports = {
      {"clamp", machine.bottom()},
      {"grip", machine.top(), {true, true, true}, moving(pivot, -fraction * pivot), pivot}};
  return machine;
}

double force_at(Simulation& simulation) { return simulation.support_reactions()[1].force.z(); }

TEST(Relaxation, FarLoadsAreAppliedInIncrementsThatLeaveNoDoubt) {
  for (const double fraction : {0.05, 0.1, 0.2}) {
    Simulation at_once = pressed(fraction).at_rest({1, 2, 1e-6, 200'000, {250}, 250});
    Simulation slowly =
        pressed(fraction).at_rest({0.05, 21, 1e-6, 200'000, std::vector<int>(20, 250), 250});
    EXPECT_NEAR(force_at(at_once), force_at(slowly), 1e-5 * std::abs(force_at(slowly)));
    EXPECT_EQ(at_once.relaxation()->last().increments > 1, fraction > 0.05);
    EXPECT_EQ(at_once.relaxation()->last().inverted, 0u);
    EXPECT_EQ(slowly.relaxation()->last().increments, 1);
    EXPECT_LT(test::largest_distance(at_once.particles(), slowly.particles()), 1e-4 * r);
  }
}

TEST(Relaxation, IncrementsGoOnWithTheSameBitsWhereverTheyAreResumed) {
  const LoadSteps steps = {1, 2, 1e-6, 200'000, {250}, 250};
  Simulation whole = pressed(0.2).at_rest(steps);
  for (const int at : {100, 400, 1200}) {
    Simulation first = pressed(0.2).relaxing(steps);
    for (int k = 0; k < at; ++k) first.step();
    Simulation second = pressed(0.2).relaxing(steps);
    second.restore(first.save());
    while (!second.relaxation()->done()) second.step();
    EXPECT_EQ(hash_of(second.particles()), hash_of(whole.particles())) << at;
    EXPECT_EQ(second.relaxation()->last().iterations, whole.relaxation()->last().iterations);
  }
}

TEST(Relaxation, AGripThatCarriesABodyAlongFeelsNothing) {
  for (const Precision precision : test::precisions) {
    Machine machine(bonded);
    machine.settings.solver.precision = precision;
    const Vec3 pivot(0, 0, machine.rest.back().z()), way(0, 0.3, 2);
    machine.world.supports = {
        {"grip", machine.top(), {true, true, true}, moving(pivot, way), pivot}};
    LoadSteps steps{0.25, 5, 1e-6, 200'000, std::vector<int>(4, 400), 50};
    steps.acceptable = 1e-4;
    if (precision == Precision::binary32) steps.residual = 1e-2;
    const Simulation simulation = machine.at_rest(steps);
    const Particles lifted = particles_at(machine.rest, r, 1);
    const double tolerance = precision == Precision::binary32 ? 0.02 : 1e-6;
    for (std::size_t i = 0; i < lifted.size(); ++i)
      EXPECT_LT((simulation.particles().position(i) - lifted.position(i) - way).norm(),
                tolerance * r);
  }
}

TEST(Relaxation, ARollerHasNoForceAlongItsFreeAxes) {
  Machine machine = cantilever();
  machine.world.supports.push_back({"roller", machine.top(), {false, true, false}});
  Simulation simulation = machine.at_rest();
  const Reaction roller = simulation.support_reactions()[1];
  EXPECT_EQ(roller.force.x(), 0);
  EXPECT_EQ(roller.force.z(), 0);
  EXPECT_GT(std::abs(roller.force.y()), 1e-3);
}

TEST(Relaxation, LastMomentMayComeSooner) {
  LoadSteps steps = two_moments();
  steps.interval = 2;
  steps.last = 0.5;
  const Simulation whole = gripped().at_rest(two_moments()), cut = gripped().at_rest(steps);
  EXPECT_EQ(cut.time(), 1);
  EXPECT_EQ(hash_of(cut.particles()), hash_of(whole.particles()));
}

TEST(Relaxation, ABarShowsItsModulus) {
  Machine machine(bonded, 41);
  machine.world.supports = {{"roller", machine.bottom(), {false, false, true}},
                            {"axis", {machine.bottom().front()}, {true, true, false}},
                            {"guide", {machine.top().front()}, {true, true, false}}};
  const double across = 5 * std::sqrt(2) * r;
  const double E = test::material_of(machine.settings).young_modulus(), strain = 0.01;
  machine.world.loads = {machine.pull(machine.top(), {0, 0, strain * E * across * across})};
  const Simulation simulation = machine.at_rest();
  double longer = 0;
  for (const std::uint32_t i : machine.top())
    longer += simulation.particles().position(i).z() - machine.rest[i].z();
  longer /= static_cast<double>(machine.top().size()) * machine.rest.back().z();
  EXPECT_NEAR(longer, strain, 0.03 * strain);  // five planes across
}

TEST(Relaxation, TakesFewMoreIterationsForLargerBodies) {
  const auto steps = [](int planes) {
    Machine machine = cantilever(bonded, planes);
    machine.rest = test::fcc_box(planes, planes, planes, r);
    machine.world.supports[0].particles = machine.bottom();
    machine.world.loads = {machine.pull(machine.top(), {0.02, 0.01, 0.05})};
    return static_cast<double>(machine.at_rest().steps());
  };
  EXPECT_LT(steps(17), 2.6 * steps(9));  // twice the size
}

TEST(Relaxation, SameBitsOnAnyNumberOfThreadsAndWhereverItIsResumed) {
  for (const Precision precision : test::precisions) {
    Machine machine = gripped();
    machine.rest = test::fcc_box(15, 15, 41, r);
    machine.settings.solver.precision = precision;
    const Vec3 pivot(0, 0, machine.rest.back().z());
    machine.world.supports[0].particles = machine.bottom();
    machine.world.supports[1] = {
        "grip", machine.top(), {true, true, true}, moving(pivot, {0, 0, 0.02}), pivot};
    LoadSteps steps = two_moments();
    if (precision == Precision::binary32) steps.residual = 0.02;
    std::uint64_t one = 0, several = 0;
    with_threads(1, [&] { one = hash_of(machine.at_rest(steps).particles()); });
    with_threads(4, [&] {
      Simulation first = machine.relaxing(steps);
      for (int k = 0; k < 77; ++k) first.step();
      Simulation second = machine.relaxing(steps);
      second.restore(first.save());
      while (!second.relaxation()->done()) second.step();
      several = hash_of(second.particles());
    });
    EXPECT_EQ(one, several);
  }
}

/// States from elsewhere, whose checksums are right.
TEST(Relaxation, RefusesStatesThatAreOnNoWayToRest) {
  Machine machine = gripped();
  const LoadSteps steps = two_moments();
  Simulation simulation = machine.relaxing(steps);
  for (int k = 0; k < 20; ++k) simulation.step();
  const SimulationState good = simulation.save();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::function<void(RelaxationState&)>> forgeries = {
      [](auto& state) { state.at_rest = -1; },
      [](auto& state) { state.at_rest = std::int64_t{1} << 60; },
      [](auto& state) { state.iterations = -1; },
      [](auto& state) { state.iterations = std::int64_t{1} << 60; },
      [](auto& state) { state.shortened = 0; },
      [=](auto& state) { state.shortened = nan; },
      [=](auto& state) { state.damping = nan; },
      [](auto& state) { state.pushed = 1e200; },
      [=](auto& state) { state.largest = nan; },
      [=](auto& state) { state.applied = -1e300; },
      [=](auto& state) { state.unbalanced = nan; }};
  for (const auto& forge : forgeries) {
    SimulationState state = good;
    RelaxationState relaxation = relaxation_in(state);
    forge(relaxation);
    put_part(state, rest_part, relaxation);
    test::expect_bad_input([&] { machine.relaxing(steps).restore(state); }, {"way to rest"});
  }
  machine.relaxing(steps).restore(good);
}

TEST(Relaxation, SinglePrecisionComesNear) {
  Machine machine = gripped();
  const Simulation exact = machine.at_rest(two_moments());
  machine.settings.solver.precision = Precision::binary32;
  LoadSteps steps = two_moments();
  steps.residual = 1e-3;
  const Simulation rounded = machine.at_rest(steps);
  EXPECT_LT(test::largest_distance(exact.particles(), rounded.particles()), 1e-3 * r);
}

TEST(Relaxation, RefusesWhatRoundingHides) {
  Machine machine = gripped();
  machine.settings.solver.precision = Precision::binary32;
  test::expect_error(Exit::unstable, [&] { machine.at_rest(two_moments()); },
                     {"load step 1 at 1 s", "rounding", "solver.precision", "solver.residual"});
}

TEST(Relaxation, RefusesLoadsBelowRoundingButNotNone) {
  Machine machine = cantilever();
  machine.settings.solver.gravity.setZero();
  machine.world.loads = {machine.pull(machine.top(), {0, 0, 1e-19})};
  test::expect_error(Exit::unstable, [&] { machine.at_rest(); },
                     {"rounding", "make the load or solver.residual larger"});
  machine.world.loads = {machine.pull(machine.top(), {0, 0, 0})};
  EXPECT_EQ(machine.at_rest().relaxation()->last().residual, 0);
}

TEST(Relaxation, DoesNotCallEquilibriumWhatIsNone) {
  LoadSteps steps = two_moments();
  steps.max_iterations = 60;
  const Machine machine = gripped();
  Simulation simulation = machine.relaxing(steps);
  test::expect_error(
      Exit::unstable,
      [&] {
        while (true) simulation.step();
      },
      {"load step 1 at 1 s", "not in equilibrium", "60 iterations", "solver.iterations"});
  EXPECT_EQ(simulation.relaxation()->moments(), 1);
  Simulation resumed = machine.relaxing(two_moments());
  resumed.restore(simulation.save());
  while (!resumed.relaxation()->done()) resumed.step();
  EXPECT_EQ(hash_of(resumed.particles()), hash_of(machine.at_rest(two_moments()).particles()));
}

TEST(Relaxation, FlowEndsAtTheYieldStress) {
  Machine machine = gripped();
  machine.settings.material.yield_strain = 0.01;
  const Vec3 pivot(0, 0, machine.rest.back().z());
  machine.world.supports[1].motion = moving(pivot, {0, 0, 0.1 * pivot.z()});
  LoadSteps steps = two_moments();
  steps.ramp = {200};
  Simulation flowing = machine.at_rest(steps);
  machine.settings.material.yield_strain.reset();
  Simulation elastic = machine.at_rest(steps);
  EXPECT_LT(flowing.support_reactions()[1].force.z(),
            0.5 * elastic.support_reactions()[1].force.z());
}

}  // namespace sinew::equilibrium_test

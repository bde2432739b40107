// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/stepping/frame_guard.h>

#include <gtest/gtest.h>
#include <cmath>
#include <string>

#include <sinew/core/parallel.h>
#include <sinew/scene/prepare.h>
#include <sinew/scene/rig.h>

#include "support/expect_error.h"
#include "support/world.h"

namespace sinew::frame_guard_test {

constexpr double r = 0.01;
constexpr int steps_per_frame = 20;

/// A bonded bar at rest, but for one particle that lies in its neighbor: it snaps out.
struct Squeezed {
  Settings settings = test::box_scene(25);
  Points rest = test::fcc_box(7, 7, 25, r);
  Particles particles;
  double step = 0;

  Squeezed() {
    constexpr std::size_t squeezed = 300;
    settings.material.model = MaterialModel::bonded;
    step = test::make_simulation(settings, rest).stepping().step;
    particles = test::particles_of(settings, rest);
    const std::size_t neighbor = test::nearest(rest, r).of(squeezed).front();
    particles.set_position(squeezed, rest[neighbor] + 0.15 * (rest[squeezed] - rest[neighbor]));
  }
  Simulation simulation() const { return test::simulation_from(settings, rest, particles, step); }
};

/// A fast particle of a bar that rests, undamped.
struct Shot {
  Settings settings = test::box_scene(25);
  Points rest = test::fcc_box(7, 7, 25, r);
  std::size_t particle = 300;
  double step = 0;

  Simulation simulation(double radii_per_step) {
    settings.material.damping = 0;
    settings.binding.bone_damping = 0;
    const Body body = test::make_body(settings, rest);
    step = 0.5 * step_limit(Integrator::symplectic_euler, body.material, body.springs);
    Particles particles = particles_at(rest, r, body.material.mass);
    particles.set_velocity(particle, {0, 0, radii_per_step * r / step});
    return Simulation(body, motion_of(settings, body.skeleton), particles,
                      stepping_of(settings.solver, step));
  }
};

struct Outcome {
  std::uint64_t hash = 0;
  GuardState guard;
  LimitedSpeeds limited;
  double residual = 0, turnover = 0;
};

Outcome outcome_of(Simulation& simulation, const FrameGuard& guard) {
  const Energies now = simulation.energies();
  return {state_hash(simulation.particles()), guard.state(), simulation.limited(), now.balance(),
          now.dissipation};
}

StepPlan plan_of(double step) { return StepPlan(step, steps_per_frame, {}); }

Outcome guarded(Simulation simulation, double step, int frames) {
  simulation.follow(plan_of(step));
  FrameGuard guard(simulation, plan_of(step));
  for (int frame = 1; frame <= frames; ++frame)
    for (guard.begin(frame); !guard.is_there();) guard.step();
  return outcome_of(simulation, guard);
}

double momentum(const Simulation& simulation) {
  double sum = 0;
  for (std::size_t i = 0; i < simulation.particles().size(); ++i)
    sum += simulation.body().material.mass * simulation.particles().velocity(i).z();
  return sum;
}

TEST(FrameGuard, ChangesNoBitOfFramesInWhichNothingFails) {
  Settings settings = test::box_scene(25);
  settings.tracks = {test::track("upper", {test::bend_key(0, 0), test::bend_key(0.3, 40)})};
  for (const Precision precision : {Precision::binary64, Precision::binary32}) {
    settings.solver.precision = precision;
    Simulation plain = test::make_simulation(settings, test::fcc_box(7, 7, 25, r));
    for (int n = 0; n < 10 * steps_per_frame; ++n) plain.step();
    const Outcome with = guarded(test::make_simulation(settings, test::fcc_box(7, 7, 25, r)),
                                 plain.stepping().step, 10);
    EXPECT_EQ(with.hash, state_hash(plain.particles()));
    EXPECT_TRUE(with.guard.divided.empty());
  }
}

TEST(FrameGuard, LetsParticlesSnapWhereEnergiesBalance) {
  const Squeezed body;
  test::expect_error(Exit::unstable, [&] { body.simulation().step(); }, {"in one step"});
  Simulation start = body.simulation();
  const double stored = start.energies().stored();
  const Outcome done = guarded(std::move(start), body.step, 10);
  EXPECT_TRUE(done.guard.divided.empty());
  EXPECT_EQ(done.limited.times, 0);
  EXPECT_LT(std::abs(done.residual - stored), 0.2 * done.turnover);
}

TEST(FrameGuard, GivesTheSameBitsOnAnyNumberOfThreads) {
  std::vector<std::uint64_t> hashes;
  for (const int threads : {1, 2, 8})
    for (const double radii : {1.5, 40.0})
      with_threads(threads, [&] {
        Shot shot;
        Simulation simulation = shot.simulation(radii);
        hashes.push_back(guarded(std::move(simulation), shot.step, 3).hash);
      });
  for (std::size_t k = 2; k < hashes.size(); ++k) EXPECT_EQ(hashes[k], hashes[k % 2]);
}

TEST(FrameGuard, TakesAFrameAnewWithHalfTheStepUntilItSucceeds) {
  for (const auto& [radii, divisor] : {std::pair(0.2, 1), {0.3, 1}, {1.5, 2}, {3.0, 4}}) {
    Shot shot;
    Simulation simulation = shot.simulation(radii);
    const Outcome done = guarded(std::move(simulation), shot.step, 1);
    EXPECT_EQ(done.guard.divisor, divisor) << radii;
    EXPECT_EQ(done.limited.times, 0) << radii;
  }
}

TEST(FrameGuard, TakesAFrameAnewWhereEnergiesDoNotBalance) {
  Shot shot;
  Simulation simulation = shot.simulation(0.9);  // collides within a step or two
  simulation.follow(plan_of(shot.step));
  FrameGuard guard(simulation, plan_of(shot.step));
  std::vector<Retake> retakes;
  guard.on_retake = [&](const Retake& why) { retakes.push_back(why); };
  for (guard.begin(1); !guard.is_there();) guard.step();
  ASSERT_EQ(retakes.size(), 1u);
  EXPECT_FALSE(retakes[0].moved_too_far);
  EXPECT_GT(retakes[0].residual, 0.2);
  EXPECT_EQ(retakes[0].divisor, 2);
}

TEST(FrameGuard, LimitsWhatNoShorterStepHeals) {
  Shot shot;
  constexpr double radii = 40, allowed = 0.2 * 16;  // in a whole step
  Simulation simulation = shot.simulation(radii);
  const double mass = simulation.body().material.mass, before = momentum(simulation);
  simulation.follow(plan_of(shot.step));
  FrameGuard guard(simulation, plan_of(shot.step));
  guard.begin(1);
  const double stored = simulation.energies().stored();
  while (simulation.limited().times == 0) guard.step();
  EXPECT_EQ(guard.state().divisor, 16);
  const LimitedSpeeds& limited = simulation.limited();
  const double fast = radii * r / shot.step, slow = allowed * r / shot.step;
  EXPECT_NEAR(limited.energy, mass / 2 * (fast * fast - slow * slow), 0.02 * limited.energy);
  EXPECT_NEAR(limited.impulse.z(), -mass * (fast - slow), 0.02 * mass * fast);
  EXPECT_NEAR(momentum(simulation) - before, limited.impulse.z(), 1e-9 * mass * fast);
  EXPECT_EQ(limited.in_frame[shot.particle], limited.times);
  while (!guard.is_there()) guard.step();
  const Outcome done = outcome_of(simulation, guard);
  EXPECT_NEAR(done.residual, stored, 0.01 * mass / 2 * slow * slow);
  EXPECT_EQ(guard.state().divisor, 16);
  guard.begin(2);
  EXPECT_EQ(guard.state().divisor, 8);  // and less and less
  EXPECT_TRUE(simulation.limited().in_frame.empty());
}

TEST(FrameGuard, StopsAtOnceWhereTheStepIsOverTheLimit) {
  Settings settings = test::box_scene(25);
  const Points rest = test::fcc_box(7, 7, 25, r);
  const Body body = test::make_body(settings, rest);
  const double step = 1.2 * step_limit(Integrator::symplectic_euler, body.material, body.springs);
  test::expect_error(
      Exit::unstable,
      [&] {
        guarded(
            test::simulation_from(settings, rest, test::shaken(rest, body.material, 0, 1e-6), step),
            step, 100);
      },
      {"over the limit of the body at rest"});
}

TEST(FrameGuard, StopsWhereManyParticlesAreTooFast) {
  Shot shot;
  Simulation simulation = shot.simulation(0);
  Particles particles = simulation.particles();
  for (std::size_t i = 0; i < particles.size(); ++i)
    particles.set_velocity(i, {0, 0, (i % 2 ? 40 : -40) * r / shot.step});
  const Body body = test::make_body(shot.settings, shot.rest);
  test::expect_error(Exit::unstable,
                     [&] {
                       guarded(Simulation(body, motion_of(shot.settings, body.skeleton), particles,
                                          stepping_of(shot.settings.solver, shot.step)),
                               shot.step, 1);
                     },
                     {"in one step"});
}

TEST(FrameGuard, GoesOnWithTheSameBitsFromAnyStepOfAFrameTakenAnew) {
  for (const double radii : {0.3, 3.0, 40.0}) {
    Shot shot;
    Simulation whole = shot.simulation(radii);
    const StepPlan plan = plan_of(shot.step);
    whole.follow(plan);
    FrameGuard guard(whole, plan);
    std::vector<SimulationState> states;
    std::vector<int> frames;
    for (int frame = 1; frame <= 3; ++frame) {
      guard.begin(frame);
      while (!guard.is_there()) {
        states.push_back(guard.save());
        frames.push_back(frame);
        guard.step();
      }
    }
    const Outcome straight = outcome_of(whole, guard);
    for (std::size_t k = 0; k < states.size(); k += 23) {
      Simulation again = shot.simulation(radii);
      again.follow(plan);
      FrameGuard resumed(again, plan);
      resumed.restore(states[k], frames[k]);
      for (int frame = frames[k];;) {
        while (!resumed.is_there()) resumed.step();
        if (++frame > 3) break;
        resumed.begin(frame);
      }
      const Outcome done = outcome_of(again, resumed);
      ASSERT_EQ(done.hash, straight.hash) << radii << " from state " << k;
      ASSERT_EQ(done.guard.divided, straight.guard.divided);
      ASSERT_EQ(done.limited.times, straight.limited.times);
      ASSERT_EQ(done.limited.energy, straight.limited.energy);
    }
  }
}

}  // namespace sinew::frame_guard_test

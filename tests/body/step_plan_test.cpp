// SPDX-License-Identifier: GPL-3.0-or-later
// Steps that are shorter for a while: when they take place, and that no energy is gained or lost
// where they change.
#include <gtest/gtest.h>

#include <sinew/body/step_plan.h>
#include <sinew/scene/prepare.h>
#include <sinew/scene/rig.h>

#include "support/all_steppers.h"

namespace sinew::step_plan_test {

constexpr double r = 0.01;

TEST(StepPlan, FillsEachIntervalWithItsSteps) {
  const std::vector<int> parts = {1, 3, 1, 7, 2};
  const StepPlan plan(0.01, 5, parts);
  EXPECT_EQ(plan.steps_until(0), 0);
  for (int interval = 0; interval < 8; ++interval) {  // beyond the last they are whole
    const int count = interval < 5 ? parts[static_cast<std::size_t>(interval)] : 1;
    const std::int64_t first = plan.steps_until(interval), next = plan.steps_until(interval + 1);
    EXPECT_EQ(next - first, 5 * count);
    EXPECT_NEAR(plan.time(first), 0.05 * interval, 1e-15);
    for (std::int64_t n = first; n < next; ++n) {
      EXPECT_DOUBLE_EQ(plan.step(n), 0.01 / count);
      EXPECT_NEAR(plan.time(n + 1) - plan.time(n), 0.01 / count, 1e-15);
      EXPECT_EQ(plan.intervals_begun(n), n == first ? interval : interval + 1) << n;
    }
  }
  EXPECT_EQ(plan.max_parts(), 7);
  EXPECT_EQ(plan.divided(), 3);
}

TEST(StepPlan, LastIntervalMayBeShorterThanTheOthers) {
  for (const std::vector<int>& parts : {std::vector<int>{1, 1, 1}, std::vector<int>{1, 3, 2}}) {
    const StepPlan plan(0.01, 5, parts, WholeSteps{2, 0.008});
    EXPECT_FALSE(plan.is_even());
    const std::int64_t begin = plan.steps_until(2), end = plan.steps_until(3);
    EXPECT_EQ(end - begin, 2 * parts[2]);
    EXPECT_NEAR(plan.time(begin), 0.1, 1e-15);
    EXPECT_NEAR(plan.time(end), 0.116, 1e-15);
    EXPECT_NEAR(plan.time(end + 1), 0.126, 1e-15);
    EXPECT_DOUBLE_EQ(plan.step(begin - 1), 0.01 / parts[1]);
    EXPECT_DOUBLE_EQ(plan.step(begin), 0.008 / parts[2]);
    EXPECT_DOUBLE_EQ(plan.step(end), 0.01);
    EXPECT_EQ(plan.intervals_begun(end), 3);
    EXPECT_EQ(plan.intervals_begun(end + 1), 4);
  }
}

TEST(StepPlan, OfWholeStepsIsThatOfEqualOnes) {
  const StepPlan plan(1.0 / 3, 4, {1, 1, 1}), equal(1.0 / 3);
  EXPECT_TRUE(plan.is_even());
  for (std::int64_t n = 0; n < 20; ++n) EXPECT_EQ(plan.time(n), equal.time(n));
  for (int i = 0; i < 5; ++i) EXPECT_EQ(plan.steps_until(i), 4 * i);
  EXPECT_EQ(plan.intervals_begun(5), 2);
}

TEST(Divided, FreeFallKeepsItsEnergyToTheLastDigits) {
  for (const Precision precision : test::precisions)
    for (const auto integrator : {Integrator::symplectic_euler, Integrator::velocity_verlet}) {
      Settings settings = test::in(precision, test::unbound(test::box_scene(9)));
      settings.solver.integrator = integrator;
      settings.solver.gravity = {0, 0, -9.81};
      const Points rest = test::fcc_box(5, 5, 9, r);
      const Body body = test::make_body(settings, rest);
      Simulation simulation(body, {}, test::shaken(rest, body.material, 0, 0),
                            stepping_of(settings.solver, 1e-3));
      simulation.follow(StepPlan(1e-3, 10, {1, 5, 1, 20, 2, 1, 1}, WholeSteps{7, 0.8e-3}));
      simulation.step();
      const double begun = simulation.energies().stored();
      const double fallen_energy = body.material.mass * rest.size() * 9.81 * 0.1;
      double most = 0;
      while (simulation.time() < 0.07) {
        simulation.step();
        most = std::max(most, std::abs(simulation.energies().stored() - begun));
      }
      EXPECT_LT(most / fallen_energy, precision == Precision::binary64 ? 1e-10 : 1e-4);
    }
}

TEST(Divided, BendsToTheSameEndAndBalancesItsEnergy) {
  for (const MaterialModel model : {MaterialModel::paper, MaterialModel::bonded_volume}) {
    Settings settings = test::box_scene(25);
    settings.material.model = model;
    settings.tracks = {test::track("upper", {test::bend_key(0, 0), test::bend_key(0.3, 40)})};
    const Points rest = test::fcc_box(7, 7, 25, r);
    const Body body = test::make_body(settings, rest);
    const double step = test::step_of(settings, body, 0.2);
    const int steps = static_cast<int>(0.1 / step);
    const auto end_of = [&](const std::vector<int>& parts, Energies& energies) {
      Simulation simulation(body, motion_of(settings, body.skeleton),
                            test::shaken(rest, body.material, 0, 0),
                            stepping_of(settings.solver, step));
      const StepPlan plan(step, steps, parts);
      simulation.follow(plan);
      while (simulation.steps() < plan.steps_until(4)) simulation.step();
      energies = simulation.energies();
      return positions_of(simulation.particles());
    };
    Energies even, divided;
    const Points a = end_of({1, 1, 1, 1}, even), b = end_of({1, 6, 1, 3}, divided);
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, (a[i] - b[i]).norm());
    EXPECT_LT(most, 0.02 * r);
    EXPECT_GT(most, 0);
    const auto open = [](const Energies& of, double at_rest) {
      return std::abs(of.stored() - at_rest + of.dissipation - of.work()) / of.work();
    };
    Simulation start(body, {}, test::shaken(rest, body.material, 0, 0),
                     stepping_of(settings.solver, step));
    const double at_rest = start.energies().stored();
    EXPECT_LT(open(divided, at_rest), std::max(2e-3, 1.5 * open(even, at_rest)));
  }
}

TEST(Divided, CountsTheListsOfStepsOfAllSizes) {
  const Settings settings = test::unbound(test::box_scene(9));
  const Points rest = test::fcc_box(5, 5, 9, r);
  const Body body = test::make_body(settings, rest);
  Simulation simulation(body, {}, test::shaken(rest, body.material, 0, 0),
                        stepping_of(settings.solver, 1e-3));
  simulation.follow(StepPlan(1e-3, 10, {1, 2, 1}));
  while (simulation.steps() < 40) simulation.step();
  EXPECT_EQ(simulation.list_counts().rebuilds, 3);  // at first, and for each other size of step
}

/// A bar whose upper bone rests, swings by 60 degrees in a tenth of a second, and rests.
Prepared swinging(std::optional<double> time_step, double interval = 0.05) {
  Settings settings = test::box_scene(25);
  settings.tracks = {test::track(
      "upper", {test::bend_key(0, 0), test::bend_key(0.5, 0), test::bend_key(0.6, 60)})};
  settings.tracks[0].interpolation = Interpolation::linear;
  settings.solver.duration = 3;
  settings.solver.time_step = time_step;
  settings.output.interval = interval;
  const Points rest = test::fcc_box(7, 7, 25, r);
  return test::prepared(settings, rest);
}

TEST(PlanOfAScene, DividesStepsWhereBonesAreFastAndForAWhileAfter) {
  const auto prepared = swinging({});
  const std::vector<double> speeds = prepared.bone_speeds;
  ASSERT_EQ(speeds.size(), 60u);
  EXPECT_EQ(speeds[5], 0);
  const double tail = prepared.body.skeleton.bones[1].length;
  EXPECT_GE(speeds[10], tail * radians(60) / 0.1);
  EXPECT_EQ(prepared.plan.parts(8), 1);
  EXPECT_GT(prepared.plan.parts(10), 1);
  EXPECT_GT(prepared.plan.parts(12), 1) << "the flesh still swings";
  EXPECT_EQ(prepared.plan.parts(59), 1);
  EXPECT_LE(farthest_carried(prepared), max_carried * (1 + 1e-12));
}

TEST(FrameTimes, EndWithTheDuration) {
  const auto times = [](double interval, double duration) {
    Settings settings;
    settings.output.interval = interval;
    settings.solver.duration = duration;
    const FrameTimes frames = frame_times(settings);
    std::vector<double> found;
    for (int frame = 0; frame <= frames.count; ++frame) found.push_back(frames.at(frame));
    return found;
  };
  EXPECT_EQ(times(0.25, 1), (std::vector<double>{0, 0.25, 0.5, 0.75, 1}));
  EXPECT_EQ(times(0.3, 1), (std::vector<double>{0, 0.3, 0.6, 3 * 0.3, 1}));
  EXPECT_EQ(times(0.1, 0.3), (std::vector<double>{0, 0.1, 0.2, 0.3}));
  EXPECT_EQ(times(1, 1), (std::vector<double>{0, 1}));
  EXPECT_EQ(times(1, 0), std::vector<double>{0});
  EXPECT_EQ(times(1.0 / 30, 3).size(), 91u);
}

TEST(PlanOfAScene, EndsWithTheDuration) {
  for (const std::optional<double> step : {std::optional<double>(), std::optional<double>(1e-3)}) {
    const auto prepared = swinging(step, 0.07);
    EXPECT_EQ(prepared.frames.count, 43);
    const std::int64_t end = prepared.plan.steps_until(43), begin = prepared.plan.steps_until(42);
    EXPECT_NEAR(prepared.plan.time(begin), 42 * 0.07, 1e-12);
    EXPECT_NEAR(prepared.plan.time(end), 3, 1e-12);
    EXPECT_LE(prepared.plan.step(begin), prepared.steps.step * (1 + 1e-12));
    EXPECT_GE(prepared.plan.step(begin) * prepared.plan.parts(42), prepared.steps.step / 2);
  }
}

TEST(PlanOfAScene, LeavesAStepThatIsGivenAsItIs) {
  const auto prepared = swinging(1e-3);
  EXPECT_TRUE(prepared.plan.is_even());
  EXPECT_GT(farthest_carried(prepared), max_carried);
}

}  // namespace sinew::step_plan_test

// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/first_pose.h>

#include <gtest/gtest.h>

#include <sinew/core/error.h>

#include "support/expect_error.h"
#include "support/world.h"

namespace sinew::first_pose_test {

constexpr double r = 0.01;

Points bar() { return test::fcc_box(7, 7, 25, r); }

/// A bar whose upper half is bent from the start.
Settings bent(double angle, Begin begin) {
  Settings settings = test::box_scene(25);
  settings.material.model = MaterialModel::bonded;
  settings.tracks = {test::track("upper", {test::bend_key(0, angle), test::bend_key(1, angle)})};
  settings.motion.begin = begin;
  return settings;
}

double largest_from(const Particles& particles, const Points& places) {
  double most = 0;
  for (std::size_t i = 0; i < particles.size(); ++i)
    most = std::max(most, (particles.position(i) - places[i]).norm());
  return most;
}

/// The largest of all forces on a particle that nothing answers, over the stiffness times r.
double unbalanced(Simulation& simulation) {
  double most = 0;
  const Forces& forces = simulation.forces();
  for (std::size_t i = 0; i < forces.pair.size(); ++i)
    most = std::max(most, (forces.pair[i] + forces.bone[i]).norm());
  return most / (simulation.body().material.stiffness() * r);
}

TEST(FirstPose, BodyBeginsSkinnedAndAtRestThere) {
  const Prepared prepared = test::prepared(bent(60, Begin::pose), bar());
  ASSERT_TRUE(prepared.beginning.posed);
  const Points places = skinned(prepared.body, pose_at(prepared.body.skeleton, prepared.motion, 0));
  Simulation simulation = start(prepared);
  EXPECT_EQ(simulation.time(), 0);
  EXPECT_LT(largest_from(simulation.particles(), places), 4 * r);
  EXPECT_GT(largest_from(simulation.particles(), bar()), 5 * r);
  EXPECT_LT(unbalanced(simulation), 1e-3);
  const Particles before = simulation.particles();
  simulation.advance(200);  // it stays there
  EXPECT_LT(test::largest_speed(simulation.particles()) * simulation.stepping().step, 1e-3 * r);
  EXPECT_LT(largest_from(simulation.particles(), positions_of(before)), 0.05 * r);
}

TEST(FirstPose, RelaxationThereIsReported) {
  std::vector<std::int64_t> iterations;
  const auto hear = [&](std::int64_t so_far, double) { iterations.push_back(so_far); };
  start(test::prepared(bent(60, Begin::pose), bar()), hear);
  ASSERT_GT(iterations.size(), 1U);
  for (std::size_t k = 1; k < iterations.size(); ++k) EXPECT_GT(iterations[k], iterations[k - 1]);
}

TEST(FirstPose, RestIsTheDefaultAndHasTheBitsOfBefore) {
  Settings settings = bent(30, Begin::rest);
  EXPECT_FALSE(test::prepared(settings, bar()).beginning.posed);
  Simulation simulation = test::make_simulation(settings, bar());
  EXPECT_EQ(largest_from(simulation.particles(), bar()), 0);
}

TEST(FirstPose, AutomaticTakesItWhereABoneTurnsFar) {
  EXPECT_TRUE(test::prepared(bent(100, Begin::automatic), bar()).beginning.posed);
  EXPECT_FALSE(test::prepared(bent(50, Begin::automatic), bar()).beginning.posed);
  Settings slow = bent(100, Begin::automatic);
  slow.motion.preroll = 1;
  EXPECT_FALSE(test::prepared(slow, bar()).beginning.posed);
  slow.motion.begin = Begin::pose;
  test::expect_bad_input([&] { test::prepared(slow, bar()); }, {"preroll"});
}

TEST(FirstPose, AFirstFrameAtRestIsPassedOver) {
  Settings settings = bent(70, Begin::pose);
  settings.tracks = {
      test::track("upper", {test::bend_key(0, 0), test::bend_key(0.1, 70), test::bend_key(1, 70)})};
  const Prepared prepared = test::prepared(settings, bar());
  EXPECT_NEAR(prepared.motion.start, 0.1, 1e-12);
  settings.motion.begin = Begin::automatic;
  EXPECT_TRUE(test::prepared(settings, bar()).beginning.posed);
  Settings slow = settings;  // a motion, and no jump
  slow.tracks[0].keys[1].time = 0.5;
  EXPECT_FALSE(test::prepared(slow, bar()).beginning.posed);
  EXPECT_NE(prepared.beginning.why.find("0.1 s of the clip"), std::string::npos);
  EXPECT_NEAR(
      degrees(rotation_vector(Quat(pose_at(prepared.body.skeleton, prepared.motion, 0)[1].turn))
                  .norm()),
      70, 1e-6);
}

TEST(FirstPose, AFirstFrameThatNobodyComesFromIsPassedOver) {
  const auto clip = [](double first, double second, double third) {
    Settings settings = bent(0, Begin::pose);
    settings.tracks[0].interpolation = Interpolation::linear;
    settings.tracks[0].keys = {test::bend_key(0, first), test::bend_key(0.01, second),
                               test::bend_key(0.02, third), test::bend_key(1, third)};
    return test::prepared(settings, bar()).motion.start;
  };
  EXPECT_NEAR(clip(20, 60, 61), 0.01, 1e-12);
  EXPECT_EQ(clip(20, 60, 100), 0);  // a fast motion
  EXPECT_EQ(clip(20, 40, 41), 0);   // as fast as a kick
}

TEST(FirstPose, InitialVelocitiesAreThoseOfTheBones) {
  Settings settings = bent(60, Begin::pose);
  settings.tracks[0].interpolation = Interpolation::linear;
  settings.tracks[0].keys[1].angle = 150;
  const Prepared prepared = test::prepared(settings, bar());
  const Pose pose = pose_at(prepared.body.skeleton, prepared.motion, 0);
  Simulation simulation = start(prepared);
  const Particles& particles = simulation.particles();
  for (std::size_t i = 0; i < particles.size(); ++i)
    EXPECT_LT((particles.velocity(i) -
               pose[static_cast<std::size_t>(prepared.body.binding.bone(i))].velocity_at(
                   particles.position(i)))
                  .norm(),
              1e-9);
  EXPECT_GT(test::largest_speed(particles), 0.1);
}

TEST(FirstPose, ARestoredRunHasTheSameBits) {
  for (const Precision precision : {Precision::binary64, Precision::binary32}) {
    Settings settings = bent(100, Begin::automatic);
    settings.solver.precision = precision;
    const Prepared prepared = test::prepared(settings, bar());
    Simulation whole = start(prepared);
    whole.advance(30);
    const SimulationState state = whole.save();
    whole.advance(30);
    Prepared again = prepared;
    again.beginning = {};
    Simulation resumed = start(std::move(again));
    resumed.restore(state);
    resumed.advance(30);
    for (std::size_t i = 0; i < whole.particles().size(); ++i)
      EXPECT_EQ(whole.particles().position(i), resumed.particles().position(i));
  }
}

}  // namespace sinew::first_pose_test

// SPDX-License-Identifier: GPL-3.0-or-later
// How a clip runs in a scene: its part, its preroll, what follows its end; and the warnings.
#include <gtest/gtest.h>

#include <sinew/core/vector.h>
#include <sinew/rig/motion.h>
#include <sinew/rig/motion_checks.h>
#include <sinew/scene/rig.h>

#include "support/expect_error.h"
#include "support/world.h"

namespace sinew::motion_time_test {

using test::bend_key;
using test::expect_bad_input;
using test::track;
using test::turned;

/// Two bones; the upper one bends from 20 degrees at 1 s to 80 at 3 s, evenly.
Settings bending() {
  Settings settings;
  settings.bones = {{"lower", "", Vec3(0, 0, 0), Vec3(0, 0, 1)},
                    {"upper", "lower", {}, Vec3(0, 0, 2)}};
  settings.tracks = {track("upper", {bend_key(1, 20), bend_key(3, 80)})};
  settings.tracks[0].interpolation = Interpolation::linear;
  settings.motion.start = 1;
  return settings;
}

struct Bend {
  double angle, rate;  // degrees, degrees/s
};

Bend bend_at(const Settings& settings, double time) {
  const Skeleton skeleton = skeleton_of(settings);
  const BonePose pose = pose_at(skeleton, motion_of(settings, skeleton), time)[1];
  return {degrees(std::atan2(pose.turn(0, 2), pose.turn(0, 0))),
          degrees(pose.angular_velocity.y())};
}

void expect_bend(const Settings& settings, double time, double angle, double rate) {
  const Bend bend = bend_at(settings, time);
  EXPECT_NEAR(bend.angle, angle, 1e-10) << time;
  EXPECT_NEAR(bend.rate, rate, 1e-10) << time;
}

TEST(ClipTime, RunsFromStartToEndAndHolds) {
  Settings settings = bending();
  expect_bend(settings, 0, 20, 30);
  expect_bend(settings, 1.5, 65, 30);
  expect_bend(settings, 2.5, 80, 0);
  settings.motion.start = 1.5;
  settings.motion.end = 2.5;
  expect_bend(settings, 0, 35, 30);
  expect_bend(settings, 0.5, 50, 30);
  expect_bend(settings, 7, 65, 0);
}

TEST(ClipTime, LoopBeginsAgain) {
  Settings settings = bending();
  settings.motion.extrapolation = Extrapolation::loop;
  for (const int round : {0, 1, 5}) expect_bend(settings, 2 * round + 0.5, 35, 30);
}

TEST(ClipTime, SpeedIsAFactorOnTheClipsRate) {
  Settings settings = bending();
  settings.motion.speed = 2;
  expect_bend(settings, 0.5, 50, 60);
  expect_bend(settings, 1.5, 80, 0);
  settings.motion.extrapolation = Extrapolation::ping_pong;
  expect_bend(settings, 1.5, 50, -60);
  settings.motion.preroll = 1;
  expect_bend(settings, 1.5, 50, 60);
}

TEST(ClipTime, PingPongGoesBackAndForth) {
  Settings settings = bending();
  settings.motion.extrapolation = Extrapolation::ping_pong;
  for (const int round : {0, 1, 5}) {
    expect_bend(settings, 4 * round + 0.5, 35, 30);
    expect_bend(settings, 4 * round + 3, 50, -30);
  }
}

TEST(ClipTime, ClipOfOneMomentHoldsWhateverFollows) {
  for (const auto kind : {Extrapolation::hold, Extrapolation::loop, Extrapolation::ping_pong}) {
    Settings settings = bending();
    settings.tracks[0].keys = {bend_key(0, 40)};
    settings.motion.start = 0;
    settings.motion.extrapolation = kind;
    expect_bend(settings, 3, 40, 0);
  }
}

TEST(ClipTime, RefusesToStartAfterTheLastKey) {
  Settings settings = bending();
  settings.motion.start = 3;
  settings.places["motion.start"] = {"s.yaml", 7, 3};
  expect_bad_input([&] { motion_of(settings, skeleton_of(settings)); },
                   {"s.yaml:7:3: ", "3 s", "; "});
}

TEST(Preroll, GoesSmoothlyFromRestToTheFirstPose) {
  Settings settings = bending();
  settings.motion.preroll = 2;
  expect_bend(settings, 0, 0, 0);
  expect_bend(settings, 1, 10, 20 * 1.5 / 2);
  expect_bend(settings, 0.5, 20 * (3.0 / 16 - 2.0 / 64), 20 * 6 * 0.25 * 0.75 / 2);
  expect_bend(settings, 2, 20, 30);
  expect_bend(settings, 3.5, 65, 30);
}

TEST(Preroll, TakesASecondPerRightAngleOrHalfTheSkeleton) {
  Settings settings = bending();
  const Skeleton skeleton = skeleton_of(settings);
  const auto needed = [&] { return preroll_for(skeleton, motion_of(settings, skeleton)); };
  EXPECT_DOUBLE_EQ(needed(), 0.3) << "20 degrees";
  settings.motion.start = 2;
  EXPECT_DOUBLE_EQ(needed(), 0.6) << "50 degrees";
  settings.tracks[0].keys = {bend_key(0, 0)};
  settings.motion.start = 0;
  EXPECT_DOUBLE_EQ(needed(), 0);
  settings.tracks[0].keys[0].translation = Vec3(0, 0, 2);
  EXPECT_DOUBLE_EQ(needed(), 2);
}

TEST(Preroll, RampsTwistTranslationAndStretchAndNeverJumps) {
  Settings settings = bending();
  KeyDefinition& key = settings.tracks[0].keys[0];
  key.twist = 400;
  key.translation = Vec3(1, 0, 2);
  key.stretch = 3;
  settings.motion.preroll = 0.4;
  const Skeleton skeleton = skeleton_of(settings);
  const Motion motion = motion_of(settings, skeleton);
  const auto half = local_motions(skeleton, motion, 0.2)[1];
  EXPECT_NEAR(degrees(half.twist), 200, 1e-10);
  EXPECT_LT((half.translation - Vec3(0.5, 0, 1)).norm(), 1e-14);
  EXPECT_NEAR(half.stretch, 2, 1e-14);
  for (double time = 0; time < 0.5; time += 1e-3) {
    const auto before = pose_at(skeleton, motion, time)[1],
               after = pose_at(skeleton, motion, time + 1e-3)[1];
    EXPECT_LT((after.frame.origin - before.frame.origin).norm(), 0.02) << time;
    EXPECT_LT((after.turn - before.turn).norm(), 0.1) << time;
  }
}

TEST(Stretch, MovesTheTailAndWhatHangsOnTheBone) {
  Settings settings = bending();
  settings.bones.push_back({"branch", "lower", Vec3(0.3, 0, 0.5), Vec3(1, 0, 0.5)});
  KeyDefinition key = bend_key(0, 90);
  key.stretch = 3;
  settings.tracks = {track("lower", {key})};
  settings.motion.start = 0;
  const Skeleton skeleton = skeleton_of(settings);
  const Pose pose = pose_at(skeleton, motion_of(settings, skeleton), 0);
  const auto near = [](const Vec3& a, const Vec3& b) { return (a - b).norm() < 1e-14; };
  EXPECT_TRUE(near(pose[1].frame.origin, {3, 0, 0}));
  EXPECT_TRUE(near(pose[2].frame.origin, {1.5, 0, -0.3}));
  EXPECT_TRUE(near(pose[0].carried({0.2, 0.1, 0.5}, skeleton.bones[0]), {1.5, 0.1, -0.2}));
  EXPECT_EQ(pose[1].stretch, 1);
}

TEST(Stretch, VelocityOfAPointIsItsDerivative) {
  Settings settings = bending();
  settings.tracks[0].keys[1].stretch = 2.5;
  settings.tracks[0].keys[1].twist = 200;
  const Skeleton skeleton = skeleton_of(settings);
  const Motion motion = motion_of(settings, skeleton);
  const Vec3 point(0.2, -0.1, 1.7);
  const auto at = [&](double time) { return pose_at(skeleton, motion, time)[1]; };
  const double h = 1e-6;
  for (const double time : {0.3, 1.1, 1.9}) {
    const Vec3 rate = (at(time + h).carried(point, skeleton.bones[1]) -
                       at(time - h).carried(point, skeleton.bones[1])) /
                      (2 * h);
    EXPECT_LT((at(time).velocity_at(at(time).carried(point, skeleton.bones[1])) - rate).norm(),
              1e-8);
  }
}

TEST(Keys, InFramesAreTheSameAsInSeconds) {
  Settings settings = bending();
  settings.motion.frame_rate = 24;
  for (KeyDefinition& key : settings.tracks[0].keys) key.frame = *key.time * 24, key.time.reset();
  expect_bend(settings, 0.5, 35, 30);
}

TEST(Keys, QuaternionsAreNormalizedWithinRoundingElseRefused) {
  Settings settings = bending();
  settings.places["motion.tracks[0].keys[0]"] = {"s.yaml", 9, 1};
  KeyDefinition key;
  key.time = 1;
  const double c = std::cos(radians(25)), s = std::sin(radians(25));
  key.quaternion = {1.0009 * c, 0, 1.0009 * s, 0};
  settings.tracks[0].keys = {key};
  settings.motion.start = 0;
  expect_bend(settings, 0, 50, 0);
  for (const double size : {0.0, 0.99, 1.01, 2.0}) {
    settings.tracks[0].keys[0].quaternion = {size * c, 0, size * s, 0};
    expect_bad_input([&] { motion_of(settings, skeleton_of(settings)); },
                     {"s.yaml:9:1: ", "quaternion of length", "; "});
  }
}

TEST(Placed, RigAndMotionTurnAndGrowTogether) {
  Settings settings = bending();
  settings.tracks[0].keys[1].translation = Vec3(0.1, 0.2, 0.3);
  settings.tracks[0].keys[1].twist = 90;
  settings.bones[1].roll = 20;
  Settings other = settings;
  other.skeleton.scale = 0.01;
  other.skeleton.up = Axis::y;  // y becomes z, z becomes x, x becomes y
  const Mat3 turn = to_scene(other.skeleton);
  EXPECT_EQ(turn * Vec3::UnitY(), Vec3::UnitZ());
  EXPECT_EQ(turn * Vec3::UnitZ(), Vec3::UnitX());
  for (const double time : {0.0, 0.7, 1.9}) {
    const Skeleton one = skeleton_of(settings), two = skeleton_of(other);
    const BonePose a = pose_at(one, motion_of(settings, one), time)[1];
    const BonePose b = pose_at(two, motion_of(other, two), time)[1];
    EXPECT_LT((b.frame.origin - 0.01 * turn * a.frame.origin).norm(), 1e-15);
    EXPECT_LT((b.turn - turn * a.turn * turn.transpose()).norm(), 1e-14);
    EXPECT_LT((b.axis() - turn * a.axis()).norm(), 1e-14);
    EXPECT_LT((b.velocity - 0.01 * turn * a.velocity).norm(), 1e-15);
    EXPECT_LT((b.angular_velocity - turn * a.angular_velocity).norm(), 1e-14);
  }
}

TEST(Placed, RigTurnsAndMovesWithRotationAndOffset) {
  Settings settings = bending(), other = settings;
  other.skeleton.rotation = Vec3(0, 90, 0);
  other.skeleton.offset = Vec3(1, 2, 3);
  const Mat3 turn = rotation_of(other.skeleton.rotation);
  for (const double time : {0.0, 0.7, 1.9}) {
    const Skeleton one = skeleton_of(settings), two = skeleton_of(other);
    const BonePose a = pose_at(one, motion_of(settings, one), time)[1];
    const BonePose b = pose_at(two, motion_of(other, two), time)[1];
    EXPECT_LT((b.frame.origin - turn * a.frame.origin - Vec3(1, 2, 3)).norm(), 1e-14);
    EXPECT_LT((b.velocity - turn * a.velocity).norm(), 1e-14);
    EXPECT_LT((b.axis() - turn * a.axis()).norm(), 1e-14);
  }
}

TEST(Placed, BonesHaveTheSidesOfBonesThatStandSoFromTheStart) {
  Settings standing = bending(), turned = bending();
  standing.bones[1].tail = Vec3(0.1, 0.3, 2);
  standing.bones[1].roll = turned.bones[1].roll = 25;
  turned.skeleton.up = Axis::y;
  const Mat3 back = to_scene(turned.skeleton).transpose();
  for (BoneDefinition& bone : turned.bones) bone.head.reset();
  turned.bones[0].head = Vec3::Zero();
  for (std::size_t b = 0; b < 2; ++b) turned.bones[b].tail = back * *standing.bones[b].tail;
  const Skeleton one = skeleton_of(standing), two = skeleton_of(turned);
  for (std::size_t b = 0; b < 2; ++b) {
    EXPECT_LT((two.bones[b].tail() - one.bones[b].tail()).norm(), 1e-15);
    EXPECT_LT((two.bones[b].rest.rotation - one.bones[b].rest.rotation).norm(), 1e-14) << b;
  }
}

std::vector<std::string> warnings_of(const Settings& settings) {
  const Skeleton skeleton = skeleton_of(settings);
  return motion_warnings(skeleton, motion_of(settings, skeleton), 1e-3);
}

void expect_warned(const Settings& settings, const std::vector<std::string>& parts) {
  const auto warnings = warnings_of(settings);
  ASSERT_EQ(warnings.size(), 1u);
  for (const std::string& part : parts)
    EXPECT_NE(warnings[0].find(part), std::string::npos) << warnings[0];
}

TEST(MotionWarnings, TellOfAStartAwayFromRestUnlessThereIsAPreroll) {
  Settings settings = bending();
  expect_warned(settings, {"'upper'", "20 degrees", "motion.preroll"});
  settings.motion.preroll = 1;
  EXPECT_TRUE(warnings_of(settings).empty());
}

TEST(MotionWarnings, TellOfLoopsThatDoNotCloseOfStepsAndOfLimits) {
  Settings settings = bending();
  settings.motion.preroll = 1;
  Settings loop = settings, step = settings, limits = settings;
  loop.motion.extrapolation = Extrapolation::loop;
  expect_warned(loop, {"'upper'", "60 degrees", "ping_pong"});
  step.tracks[0].interpolation = Interpolation::step;
  expect_warned(step, {"'upper'", "jumps"});
  Settings still = step;
  for (KeyDefinition& key : still.tracks[0].keys) key.angle = 0;
  EXPECT_TRUE(warnings_of(still).empty()) << "steps between equal values";
  Settings baked = step;
  baked.tracks[0].keys.clear();
  for (int k = 0; k < 100; ++k) baked.tracks[0].keys.push_back(bend_key(1 + 0.02 * k, 0.5 * k));
  EXPECT_TRUE(warnings_of(baked).empty()) << "steps of half a degree, up to 50";
  limits.bones[1].limits.swing = 50;
  expect_warned(limits, {"'upper'", "swing by 30 degrees", "first at 2.5 s", "; "});
}

}  // namespace sinew::motion_time_test

// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/rig/motion.h>

#include <gtest/gtest.h>

#include <sinew/rig/pose.h>
#include <sinew/scene/rig.h>

#include "support/expect_error.h"
#include "support/world.h"

namespace sinew::motion_test {

using test::bend_key;
using test::expect_bad_input;
using test::track;
using test::turned;
using test::twist_key;

constexpr Interpolation every_way[] = {Interpolation::step, Interpolation::linear,
                                       Interpolation::smooth, Interpolation::cubic};

/// Bones b0, b1, b2 of length 1 along z from the origin, one on the other.
Settings chain(int bones) {
  Settings settings;
  settings.bones = {{"b0", "", Vec3(0, 0, 0), Vec3(0, 0, 1)},
                    {"b1", "b0", {}, Vec3(0, 0, 2)},
                    {"b2", "b1", {}, Vec3(0, 0, 3)}};
  settings.bones.resize(bones);
  return settings;
}

Pose pose_of(const Settings& settings, double time) {
  const Skeleton skeleton = skeleton_of(settings);
  return pose_at(skeleton, motion_of(settings, skeleton), time);
}

KeyDefinition shift_key(double time, const Vec3& shift) {
  KeyDefinition key;
  key.time = time;
  key.translation = shift;
  return key;
}

void expect_near(const Vec3& found, const Vec3& expected, double tolerance = 1e-14) {
  EXPECT_LT((found - expected).norm(), tolerance)
      << found.transpose() << " for " << expected.transpose();
}

TEST(Pose, AtRestIsTheRestFrame) {
  const Skeleton skeleton = skeleton_of(chain(3));
  const Pose pose = rest_pose(skeleton);
  for (std::size_t b = 0; b < 3; ++b) {
    expect_near(pose[b].frame.origin, skeleton.bones[b].head());
    EXPECT_EQ(pose[b].frame.rotation, skeleton.bones[b].rest.rotation);
    EXPECT_EQ(pose[b].turn, Mat3::Identity());
    EXPECT_EQ(pose[b].velocity, Vec3::Zero());
    EXPECT_EQ(pose[b].angular_velocity, Vec3::Zero());
  }
}

TEST(Pose, BendTurnsABoneAndItsChildrenAboutItsHead) {
  Settings settings = chain(3);
  settings.tracks = {track("b1", {bend_key(0, 0), bend_key(1, 90)})};
  const Pose pose = pose_of(settings, 1);
  expect_near(pose[0].axis(), Vec3::UnitZ());
  expect_near(pose[1].frame.origin, {0, 0, 1});
  expect_near(pose[1].axis(), Vec3::UnitX());
  expect_near(pose[2].frame.origin, {1, 0, 1});
  expect_near(pose[2].axis(), Vec3::UnitX());
}

TEST(Pose, TwistPasses180DegreesInItsDirection) {
  Settings settings = chain(2);
  settings.tracks = {track("b1", {twist_key(0, 0), twist_key(1, 540)})};
  settings.tracks[0].interpolation = Interpolation::linear;
  for (const double time : {0.2, 0.5, 0.9, 1.0}) {
    const BonePose bone = pose_of(settings, time)[1];
    EXPECT_NEAR(degrees(bone.twist), 540 * time, 1e-11);
    EXPECT_LT((bone.turn - turned(Vec3::UnitZ(), 540 * time)).norm(), 1e-13);
    expect_near(bone.angular_velocity, {0, 0, time < 1 ? radians(540) : 0}, 1e-12);
    expect_near(bone.axis(), Vec3::UnitZ());
  }
}

TEST(Pose, ComposesTwoTurningBonesOfAChain) {
  Settings settings = chain(2);
  settings.tracks = {track("b0", {bend_key(0, 0), bend_key(1, 30)}),
                     track("b1", {bend_key(0, 0), bend_key(1, 45)})};
  KeyDefinition& key = settings.tracks[1].keys[1];
  key.axis = Vec3(2, 0, 0);
  key.twist = 200;
  const Pose pose = pose_of(settings, 2);
  const Mat3 parent = turned(Vec3::UnitY(), 30);
  const Mat3 child = parent * turned(Vec3::UnitX(), 45) * turned(Vec3::UnitZ(), 200);
  expect_near(pose[1].frame.origin, parent * Vec3::UnitZ());
  EXPECT_LT((pose[1].turn - child).norm(), 1e-14);
}

TEST(Pose, TranslationShiftsTheHeadInTheParentsDirections) {
  Settings settings = chain(2);
  settings.tracks = {track("b0", {bend_key(0, 90)}),
                     track("b1", {shift_key(0, {0, 0, 0}), shift_key(1, {0.1, 0.2, 0.5})})};
  const Pose pose = pose_of(settings, 1);  // z has become x, and x has become -z
  expect_near(pose[1].frame.origin, {1.5, 0.2, -0.1});
}

TEST(Pose, HoldsBeforeTheFirstKeyAndAfterTheLast) {
  for (const auto kind : every_way) {
    Settings settings = chain(2);
    settings.tracks = {track("b1", {bend_key(1, 20), bend_key(2, 70)})};
    settings.tracks[0].interpolation = kind;
    for (const auto& [time, angle] : {std::pair(0.0, 20), {0.999, 20}, {2.0, 70}, {50.0, 70}}) {
      const BonePose bone = pose_of(settings, time)[1];
      EXPECT_LT((bone.turn - turned(Vec3::UnitY(), angle)).norm(), 1e-14) << time;
      EXPECT_EQ(bone.angular_velocity, Vec3::Zero()) << time;
    }
  }
}

TEST(Pose, InterpolationsPassTheFirstQuarterAsTheySay) {
  Settings settings = chain(1);
  settings.tracks = {track("b0", {bend_key(0, 0), bend_key(2, 80)})};
  for (const auto& [kind, quarter] : {std::pair(Interpolation::step, 0.0),
                                      {Interpolation::linear, 20.0},
                                      {Interpolation::smooth, 80 * (3.0 / 16 - 2.0 / 64)}}) {
    settings.tracks[0].interpolation = kind;
    EXPECT_LT((pose_of(settings, 0.5)[0].turn - turned(Vec3::UnitY(), quarter)).norm(), 1e-14);
  }
}

TEST(Pose, SmoothMotionHasNoSpeedAtItsKeys) {
  Settings settings = chain(2);
  settings.tracks = {track("b1", {bend_key(0, 0), bend_key(1, 40), bend_key(2.5, -30)})};
  settings.tracks[0].keys[1].twist = 300;
  settings.tracks[0].keys[2].translation = Vec3(1, 2, 3);
  for (const double key : {0.0, 1.0, 2.5})
    for (const double time : {key - 1e-9, key, key + 1e-9}) {
      const BonePose bone = pose_of(settings, time)[1];
      EXPECT_LT(bone.velocity.norm(), 1e-7);
      EXPECT_LT(bone.angular_velocity.norm(), 1e-7);
    }
}

/// A chain whose three bones turn, twist and shift at once.
Settings busy_chain(Interpolation kind) {
  Settings settings = chain(3);
  std::mt19937 random(3);
  for (const char* bone : {"b0", "b1", "b2"}) {
    std::vector<KeyDefinition> keys;
    for (const double time : {0.0, 0.7, 1.5, 2.0}) {
      KeyDefinition key = bend_key(time, 170 * test::random_vector(random).x());
      key.axis = test::random_vector(random);
      key.twist = 700 * test::random_vector(random).x();
      key.translation = test::random_vector(random);
      key.stretch = 1 + test::random_vector(random).x();
      keys.push_back(key);
    }
    settings.tracks.push_back(track(bone, keys));
    settings.tracks.back().interpolation = kind;
  }
  return settings;
}

void expect_derivatives(const Settings& settings, double time) {
  const double h = 1e-5;
  const Pose now = pose_of(settings, time), before = pose_of(settings, time - h),
             after = pose_of(settings, time + h);
  for (std::size_t b = 0; b < now.size(); ++b) {
    const Mat3 spin = (after[b].turn - before[b].turn) / (2 * h) * now[b].turn.transpose();
    const double scale = 1 + now[b].angular_velocity.norm(), error = 1e-8 * std::pow(scale, 3);
    expect_near(now[b].velocity, (after[b].frame.origin - before[b].frame.origin) / (2 * h), error);
    expect_near(now[b].angular_velocity, {spin(2, 1), spin(0, 2), spin(1, 0)}, error);
  }
}

TEST(Pose, VelocitiesAreTheDerivativesOfThePose) {
  for (const auto kind : every_way)
    for (const double time : {0.1, 0.35, 0.69, 0.9, 1.2, 1.7, 1.95})
      expect_derivatives(busy_chain(kind), time);
}

TEST(PoseCursor, GivesTheSameBitsInAnyOrderOfTimes) {
  for (const auto kind : every_way)
    for (const auto after : {Extrapolation::hold, Extrapolation::loop, Extrapolation::ping_pong}) {
      Settings settings = busy_chain(kind);
      settings.tracks.erase(settings.tracks.begin() + 1);  // b1 follows its parent
      settings.bones[2].limits.swing = 60;
      settings.motion.extrapolation = after;
      settings.motion.preroll = 0.5;
      const Skeleton skeleton = skeleton_of(settings);
      const Motion motion = motion_of(settings, skeleton);
      PoseCursor cursor(skeleton, motion);
      for (const double time : {0.0, 0.2, 0.5, 1.1, 1.2, 1.21, 3.9, 2.5, 2.4, 0.1, 7.0, 1.2}) {
        const Pose& pose = cursor.at(time);
        const Pose alone = pose_at(skeleton, motion, time);
        for (std::size_t b = 0; b < pose.size(); ++b) {
          EXPECT_EQ(pose[b].frame.origin, alone[b].frame.origin) << time;
          EXPECT_EQ(pose[b].frame.rotation, alone[b].frame.rotation) << time;
          EXPECT_EQ(pose[b].velocity, alone[b].velocity) << time;
          EXPECT_EQ(pose[b].angular_velocity, alone[b].angular_velocity) << time;
          EXPECT_EQ(pose[b].stretch_rate, alone[b].stretch_rate) << time;
        }
      }
    }
}

TEST(Pose, AnglesAboutOneAxisMayExceedAFullTurn) {
  Settings settings = chain(1);
  KeyDefinition start;  // no rotation counts as no angle
  start.time = 0;
  settings.tracks = {track("b0", {start, bend_key(1, 270), bend_key(2, -90)})};
  settings.tracks[0].interpolation = Interpolation::linear;
  for (const double time : {0.3, 0.8, 1.0})
    EXPECT_LT((pose_of(settings, time)[0].turn - turned(Vec3::UnitY(), 270 * time)).norm(), 1e-13);
  EXPECT_NEAR(pose_of(settings, 1.5)[0].angular_velocity.y(), radians(-360), 1e-12);
}

TEST(Pose, EulerAnglesBetweenKeysTakeTheShortestRotation) {
  Settings settings = chain(1);
  KeyDefinition quarter, three_quarters;
  quarter.time = 0;
  quarter.euler = Vec3(0, 0, 0);
  three_quarters.time = 1;
  three_quarters.euler = Vec3(0, 270, 0);
  settings.tracks = {track("b0", {quarter, three_quarters})};
  settings.tracks[0].interpolation = Interpolation::linear;
  EXPECT_LT((pose_of(settings, 0.5)[0].turn - turned(Vec3::UnitY(), -45)).norm(), 1e-13);
}

TEST(Motion, EulerAnglesTurnAboutFixedAxesInTheOrderNamed) {
  const Mat3 x = turned(Vec3::UnitX(), 20), y = turned(Vec3::UnitY(), 35),
             z = turned(Vec3::UnitZ(), -50);
  const std::pair<const char*, Mat3> orders[] = {{"xyz", z * y * x}, {"xzy", y * z * x},
                                                 {"yxz", z * x * y}, {"yzx", x * z * y},
                                                 {"zxy", y * x * z}, {"zyx", x * y * z}};
  for (const auto& [order, expected] : orders) {
    Settings settings = chain(1);
    KeyDefinition key;
    key.time = 0;
    key.euler = Vec3(20, 35, -50);
    settings.tracks = {track("b0", {key})};
    settings.tracks[0].order = order;
    EXPECT_LT((pose_of(settings, 0)[0].turn - expected).norm(), 1e-14) << order;
  }
}

/// A bend of b1 whose values were all read at known lines.
Settings placed_bend() {
  Settings settings = chain(2);
  settings.tracks = {track("b1", {bend_key(0, 0), bend_key(1, 90)})};
  settings.places = {{"motion.tracks[0]", {"s.yaml", 20, 3}},
                     {"motion.tracks[0].bone", {"s.yaml", 21, 5}},
                     {"motion.tracks[0].order", {"s.yaml", 22, 5}},
                     {"motion.tracks[0].keys[1]", {"s.yaml", 30, 9}},
                     {"motion.tracks[1].bone", {"s.yaml", 41, 5}}};
  return settings;
}

void expect_refused(const Settings& settings, const std::vector<std::string>& parts) {
  expect_bad_input([&] { motion_of(settings, skeleton_of(settings)); }, parts);
}

TEST(Motion, RefusesUnknownBonesAndTwoTracksOfOne) {
  Settings settings = placed_bend();
  settings.tracks[0].bone = "b7";
  expect_refused(settings, {"s.yaml:21:5: ", "'b7'", "; "});
  settings = placed_bend();
  settings.tracks.push_back(settings.tracks[0]);
  expect_refused(settings, {"s.yaml:41:5: ", "'b1'", "two tracks", "; "});
}

TEST(Motion, RefusesKeysOutOfOrderAndTracksWithoutKeys) {
  for (const double time : {0.0, -1.0}) {
    Settings settings = placed_bend();
    settings.tracks[0].keys[1].time = time;
    expect_refused(settings, {"s.yaml:30:9: ", "ascending", "; "});
  }
  Settings settings = placed_bend();
  settings.tracks[0].keys.clear();
  expect_refused(settings, {"s.yaml:20:3: ", "without keys", "; "});
}

TEST(Motion, RefusesRotationsThatAreHalfGivenOrGivenTwice) {
  Settings twice = placed_bend(), no_axis = twice, zero_axis = twice, no_angle = twice;
  twice.tracks[0].keys[1].euler = Vec3(1, 2, 3);
  no_axis.tracks[0].keys[1].axis.reset();
  zero_axis.tracks[0].keys[1].axis = Vec3::Zero();
  no_angle.tracks[0].keys[1].angle.reset();
  expect_refused(twice, {"s.yaml:30:9: ", "twice", "; "});
  expect_refused(no_axis, {"s.yaml:30:9: ", "axis", "; "});
  expect_refused(zero_axis, {"s.yaml:30:9: ", "axis", "; "});
  expect_refused(no_angle, {"s.yaml:30:9: ", "angle", "; "});
}

TEST(Motion, RefusesOrdersThatAreNone) {
  for (const char* order : {"", "xy", "xxz", "XYZ", "xyzx"}) {
    Settings settings = placed_bend();
    settings.tracks[0].order = order;
    expect_refused(settings, {"s.yaml:22:5: ", "order", "; "});
  }
}

}  // namespace sinew::motion_test

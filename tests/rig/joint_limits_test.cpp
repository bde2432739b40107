// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <sinew/core/vector.h>
#include <sinew/rig/motion_checks.h>
#include <sinew/scene/rig.h>

#include "support/world.h"

namespace sinew::joint_limits_test {

/// One bone along `axis` that may lean 40 degrees and turn from -20 to 30.
Skeleton limited_bone(const Vec3& axis) {
  Settings settings;
  settings.bones = {{"b", "", Vec3(1, 2, 3), Vec3(Vec3(1, 2, 3) + axis)}};
  settings.bones[0].limits.swing = 40;
  settings.bones[0].limits.twist = {-20, 30};
  return skeleton_of(settings);
}

/// Rotations over time about changing axes, far beyond the joint's limits.
Motion wild() {
  std::mt19937 random(4);
  Track track;
  track.bone = 0;
  track.rotation.interpolation = track.twist.interpolation = Interpolation::cubic;
  for (int k = 0; k < 8; ++k) {
    track.rotation.times.push_back(k);
    track.rotation.values.push_back(rotation_by(4 * test::random_vector(random)));
    track.twist.times.push_back(k);
    track.twist.values.push_back(test::random_vector(random).x());
  }
  Motion motion;
  motion.tracks = {track};
  return motion;
}

struct Angles {
  double lean, twist;
};

Angles angles_of(const Skeleton& skeleton, const BonePose& pose) {
  const Vec3 from = skeleton.bones[0].axis(), to = pose.axis();
  const Mat3 swing = Quat::FromTwoVectors(from, to).toRotationMatrix();
  const Quat twist(Mat3(swing.transpose() * pose.turn));
  return {std::atan2(from.cross(to).norm(), from.dot(to)),
          2 * std::atan2(twist.vec().dot(from), twist.w())};
}

double wrapped(double angle) { return std::remainder(angle, 2 * pi); }

TEST(JointLimits, RestrictTheBone) {
  for (const Vec3& axis : {Vec3(0, 0, 1), Vec3(1, -2, 0.5)}) {
    const Skeleton skeleton = limited_bone(axis);
    bool swing = false, twist = false;
    for (double time = 0; time <= 7; time += 0.01) {
      const Angles angles = angles_of(skeleton, pose_at(skeleton, wild(), time)[0]);
      EXPECT_LT(angles.lean, radians(40) + 1e-9) << time;
      EXPECT_GT(wrapped(angles.twist), radians(-20) - 1e-9) << time;
      EXPECT_LT(wrapped(angles.twist), radians(30) + 1e-9) << time;
      swing |= std::abs(angles.lean - radians(40)) < 1e-9;
      twist |= std::abs(wrapped(angles.twist) - radians(30)) < 1e-9;
    }
    EXPECT_TRUE(swing && twist);
  }
}

TEST(JointLimits, LeaveAloneWhatTheyAllow) {
  const Skeleton skeleton = limited_bone(Vec3::UnitZ());
  Motion motion = wild();
  for (Quat& value : motion.tracks[0].rotation.values)
    value = rotation_by(0.08 * rotation_vector(value));
  for (double& value : motion.tracks[0].twist.values) value *= 0.1;
  Skeleton free = skeleton;
  free.bones[0].limits = {};
  for (double time = 0; time <= 7; time += 0.1)
    EXPECT_EQ(pose_at(skeleton, motion, time)[0].turn, pose_at(free, motion, time)[0].turn);
  EXPECT_TRUE(limits_passed(skeleton, motion).empty());
}

TEST(JointLimits, VelocitiesAreThoseOfTheLimitedMotion) {
  for (const Vec3& axis : {Vec3(0, 0, 1), Vec3(1, -2, 0.5)}) {
    const Skeleton skeleton = limited_bone(axis);
    int bad = 0, samples = 0;  // near a limit the difference quotient is not the rate
    for (double time = 0.05; time < 7; time += 0.0123) {
      const double h = 1e-6;
      const Mat3 before = pose_at(skeleton, wild(), time - h)[0].turn,
                 after = pose_at(skeleton, wild(), time + h)[0].turn;
      const Vec3 rate = rotation_vector(Quat(Mat3(after * before.transpose()))) / (2 * h);
      const Vec3 spin = pose_at(skeleton, wild(), time)[0].angular_velocity;
      bad += (rate - spin).norm() > 1e-5 * (1 + spin.norm());
      ++samples;
    }
    EXPECT_LE(bad, 2) << "of " << samples;
  }
}

TEST(JointLimits, ReportBoneTimeAndExcess) {
  Skeleton skeleton = limited_bone(Vec3::UnitZ());
  Motion motion;
  motion.preroll = 0.5;
  Track track;
  track.bone = 0;
  track.rotation.times = track.twist.times = {0, 1, 2};
  track.rotation.values = {Quat::Identity(), rotation_by(radians(60) * Vec3::UnitX()),
                           Quat::Identity()};
  track.twist.values = {0, radians(-400), 0};
  motion.tracks = {track};
  const auto passed = limits_passed(skeleton, motion);
  ASSERT_EQ(passed.size(), 1u);
  EXPECT_EQ(passed[0].bone, 0);
  EXPECT_NEAR(passed[0].time, 0.75, 1e-12);  // the first sample beyond -20 degrees
  EXPECT_NEAR(degrees(passed[0].most.swing), 20, 1e-9);
  EXPECT_NEAR(degrees(passed[0].most.twist), 380, 1e-9);
}

}  // namespace sinew::joint_limits_test

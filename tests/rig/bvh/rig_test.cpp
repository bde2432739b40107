// SPDX-License-Identifier: GPL-3.0-or-later
// The skeleton and the clip that a BVH file gives: closed forms of two joints, options, limits.
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>

#include <sinew/rig/bvh/bvh.h>

#include "rig/bvh/bvh_files.h"
#include "support/expect_error.h"

namespace sinew::rig_test {

using bvh_files::arm;
using test::expect_bad_input;

Mat3 turned(int axis, double angle) {
  return Eigen::AngleAxisd(radians(angle), Vec3::Unit(axis)).toRotationMatrix();
}

/// Options for which the file's directions are the scene's.
BvhOptions as_is() {
  BvhOptions options;
  options.up = "z";
  options.forward = "x";
  return options;
}

Rig rig_from(const std::string& text, const BvhOptions& options = as_is()) {
  return rig_of(parse_bvh(text, "test.bvh"), options);
}

Mat3 rotation(const Track& track, std::size_t key) {
  return track.rotation.values[key].toRotationMatrix();
}

/// One joint that turns about `order` (letters, the first outermost) by these angles.
Mat3 euler(const std::string& order, const Vec3& angles) {
  std::string channels = "CHANNELS " + std::to_string(order.size());
  std::string motion = "MOTION\nFrames: 1\nFrame Time: 1\n";
  for (std::size_t i = 0; i < order.size(); ++i) {
    channels += std::string(" ") + order[i] + "rotation";
    motion += std::to_string(angles[static_cast<int>(i)]) + " ";
  }
  return rotation(rig_from(arm(channels, "", motion)).clips.at(0).motion.tracks.at(0), 0);
}

TEST(BvhRig, TheFirstChannelIsTheOutermostRotationInEveryOrder) {
  std::string order = "XYZ";
  do {
    const Mat3 expected =
        turned(order[0] - 'X', 20) * turned(order[1] - 'X', -75) * turned(order[2] - 'X', 140);
    EXPECT_LT((euler(order, {20, -75, 140}) - expected).norm(), 1e-14) << order;
  } while (std::next_permutation(order.begin(), order.end()));
  EXPECT_LT((euler("ZX", {20, -75, 0}) - turned(2, 20) * turned(0, -75)).norm(), 1e-14);
  EXPECT_LT((euler("Y", {200, 0, 0}) - turned(1, 200)).norm(), 1e-14);
}

TEST(BvhRig, OrdersDifferWithinAFileAndPositionsStandAnywhere) {
  const Rig rig = rig_from(bvh_files::small);
  const auto& tracks = rig.clips.at(0).motion.tracks;
  ASSERT_EQ(tracks.size(), 3u);
  const Mat3 hip = turned(2, 11) * turned(0, 12) * turned(1, 13),
             knee = turned(1, 14) * turned(0, 15) * turned(2, 16),
             foot = turned(0, 17) * turned(2, 18) * turned(1, 19);
  EXPECT_LT((rotation(tracks[0], 1) - hip).norm(), 1e-14);
  EXPECT_LT((rotation(tracks[1], 1) - knee).norm(), 1e-14);
  EXPECT_LT((rotation(tracks[2], 1) - foot).norm(), 1e-14);
  EXPECT_EQ(tracks[0].translation.values[1], Vec3(0.5, 0, 0));
  EXPECT_TRUE(tracks[1].translation.times.empty());
  EXPECT_EQ(tracks[2].translation.values[1], Vec3(0, 0.25, 0));
}

TEST(BvhRig, BonesStandAtTheOffsetsAndEndAtTheEndSite) {
  const Skeleton skeleton = rig_from(bvh_files::small).skeleton;
  ASSERT_EQ(skeleton.size(), 3u);
  EXPECT_EQ(skeleton.bones[0].head(), Vec3(0, 1.5, 0.25));
  EXPECT_EQ(skeleton.bones[1].head(), Vec3(0, 1, 0.25));
  EXPECT_EQ(skeleton.bones[2].head(), Vec3(0, 0.5, 0.375));
  EXPECT_LT((skeleton.bones[1].tail() - skeleton.bones[2].head()).norm(), 1e-15);
  EXPECT_LT((skeleton.bones[2].tail() - Vec3(0, 0.5, 0.625)).norm(), 1e-15);
}

TEST(BvhRig, TheClipKeepsTheFramesAndTheirTimes) {
  BvhOptions options = as_is();
  options.name = "walk";
  const Clip clip = rig_from(bvh_files::small, options).clips.at(0);
  EXPECT_EQ(clip.name, "walk");
  EXPECT_EQ(clip.frames, 3);
  EXPECT_EQ(clip.frame_time, 0.125);
  EXPECT_EQ(clip.duration, 0.25);
  EXPECT_EQ(clip.motion.tracks[0].rotation.times, (std::vector{0.0, 0.125, 0.25}));
  EXPECT_EQ(clip.motion.tracks[0].rotation.interpolation, Interpolation::linear);
}

const char* const moves = "CHANNELS 3 Xposition Yposition Zposition";
const std::string move_by_3 = "MOTION\nFrames: 1\nFrame Time: 1\n0 0 0 3 4 5\n";

TEST(BvhRig, PositionsReplaceTheOffsetOrAddToIt) {
  BvhOptions options = as_is();
  const std::string text = arm(moves, moves, move_by_3);
  const auto elbow = [&] { return rig_from(text, options).clips.at(0).motion.tracks.at(1); };
  EXPECT_EQ(elbow().translation.values.at(0), Vec3(3, 3, 5));  // the offset is 0 1 0
  options.positions = BvhPositions::add;
  EXPECT_EQ(elbow().translation.values.at(0), Vec3(3, 4, 5));
}

TEST(BvhRig, WhereThereIsNoPositionChannelTheOffsetHolds) {
  const std::string text = arm("CHANNELS 1 Xposition", "CHANNELS 1 Zposition",
                               "MOTION\nFrames: 1\nFrame Time: 1\n2 7\n");
  const auto tracks = rig_from(text).clips.at(0).motion.tracks;
  EXPECT_EQ(tracks.at(0).translation.values.at(0), Vec3(2, 0, 0));
  EXPECT_EQ(tracks.at(1).translation.values.at(0), Vec3(0, 0, 7));
  EXPECT_TRUE(tracks.at(1).rotation.times.empty());
}

TEST(BvhRig, ScaleHoldsForOffsetsAndPositionsAlike) {
  BvhOptions options = as_is();
  options.scale = 0.25;
  const Rig rig = rig_from(arm(moves, moves, move_by_3), options);
  EXPECT_EQ(rig.skeleton.bones[1].head(), Vec3(0, 0.25, 0));
  EXPECT_EQ(rig.skeleton.bones[1].length, 0.25);
  EXPECT_EQ(rig.clips[0].motion.tracks[1].translation.values[0], Vec3(0.75, 0.75, 1.25));
}

TEST(BvhRig, ByDefaultYIsUpAndZForward) {
  const Rig rig = rig_from(bvh_files::small, {});
  EXPECT_EQ(rig.skeleton.bones[2].head(), Vec3(0.375, 0, 0.5));
  const Mat3 hip = turned(0, 1) * turned(1, 2) * turned(2, 3);  // z is the scene's x, x its y
  EXPECT_LT((rotation(rig.clips[0].motion.tracks[0], 0) - hip).norm(), 1e-14);
}

TEST(BvhRig, EveryChoiceOfAxesIsARotationOfTheWholeMotion) {
  const Rig plain = rig_from(bvh_files::small);
  int choices = 0;
  for (const std::string up : {"x", "-x", "y", "-y", "+z", "-z"})
    for (const std::string forward : {"x", "-x", "y", "-y", "z", "-z"}) {
      if (up.back() == forward.back()) continue;
      BvhOptions options = as_is();
      options.up = up;
      options.forward = forward;
      const auto vector = [](const std::string& name) -> Vec3 {
        return (name[0] == '-' ? -1.0 : 1.0) * Vec3::Unit(name.back() - 'x');
      };
      Mat3 axes;
      axes << vector(forward), vector(up).cross(vector(forward)), vector(up);
      axes.transposeInPlace();
      const Rig rig = rig_from(bvh_files::small, options);
      for (std::size_t i = 0; i < 3; ++i) {
        const Track &a = rig.clips[0].motion.tracks[i], &b = plain.clips[0].motion.tracks[i];
        const Mat3 expected = axes * rotation(b, 2) * axes.transpose();
        EXPECT_LT((rotation(a, 2) - expected).norm(), 1e-14);
        EXPECT_EQ(rig.skeleton.bones[i].head(), axes * plain.skeleton.bones[i].head());
        ASSERT_EQ(a.translation.values.size(), b.translation.values.size());
        for (std::size_t key = 0; key < b.translation.values.size(); ++key)
          EXPECT_EQ(a.translation.values[key], axes * b.translation.values[key]);
      }
      ++choices;
    }
  EXPECT_EQ(choices, 24);
}

TEST(BvhRig, StartAndEndCutTheClipAndBeginAtZero) {
  BvhOptions options = as_is();
  options.start = 1;
  options.end = 2;
  const Clip clip = rig_from(bvh_files::small, options).clips.at(0);
  const Clip whole = rig_from(bvh_files::small).clips.at(0);
  EXPECT_EQ(clip.frames, 2);
  EXPECT_EQ(clip.duration, 0.125);
  EXPECT_EQ(clip.motion.tracks[1].rotation.times, (std::vector{0.0, 0.125}));
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_EQ(clip.motion.tracks[1].rotation.values[i].coeffs(),
              whole.motion.tracks[1].rotation.values[i + 1].coeffs());
  options.start = 2;
  EXPECT_EQ(rig_from(bvh_files::small, options).clips.at(0).duration, 0);
}

TEST(BvhRig, NeighboringQuaternionsLieOnTheSameSide) {
  std::string motion = "MOTION\nFrames: 100\nFrame Time: 1\n";
  for (int i = 0; i < 100; ++i) motion += std::to_string(i * 47 % 360 - 180) + "\n";
  const Rig rig = rig_from(arm("CHANNELS 1 Yrotation", "", motion));
  const auto& values = rig.clips.at(0).motion.tracks.at(0).rotation.values;
  for (std::size_t i = 1; i < values.size(); ++i)
    EXPECT_NEAR(values[i].dot(values[i - 1]), std::cos(radians(47) / 2), 1e-12);
}

TEST(BvhRig, ResamplingIsSlerpAndStraightLines) {
  BvhOptions options = as_is();
  options.rate = 16;
  const Clip fine = rig_from(bvh_files::small, options).clips.at(0);
  const Clip own = rig_from(bvh_files::small).clips.at(0);
  EXPECT_EQ(fine.frames, 5);
  EXPECT_EQ(fine.frame_time, 0.0625);
  EXPECT_EQ(fine.duration, 0.25);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto &a = fine.motion.tracks[i].rotation, &b = own.motion.tracks[i].rotation;
    for (std::size_t key = 0; key < 3; ++key)
      EXPECT_LT((a.values[2 * key].coeffs() - b.values[key].coeffs()).norm(), 1e-15);
    for (std::size_t key = 0; key < 2; ++key) {
      const Quat middle = b.values[key].slerp(0.5, b.values[key + 1]);
      EXPECT_LT((a.values[2 * key + 1].coeffs() - middle.coeffs()).norm(), 1e-14);
    }
  }
  EXPECT_EQ(fine.motion.tracks[0].translation.values[1], Vec3(0.25, 0, 0));
}

TEST(BvhRig, ARateThatDividesTheClipKeepsItsLastFrame) {
  std::string motion = "MOTION\nFrames: 4501\nFrame Time: 0.0083333333\n";
  for (int i = 0; i <= 4500; ++i) motion += "1\n";
  const std::string text = arm("CHANNELS 1 Yrotation", "", motion);
  BvhOptions options = as_is();
  for (const double rate : {30.0, 60.0, 120.0, 240.0}) {
    options.rate = rate;
    EXPECT_EQ(rig_from(text, options).clips.at(0).frames, static_cast<int>(37.5 * rate) + 1);
  }
  options.rate = 7;  // 262.5 steps
  EXPECT_EQ(rig_from(text, options).clips.at(0).frames, 263);
}

TEST(BvhRig, RefusesOptionsOutOfRange) {
  const auto refuse = [](auto change, const std::vector<std::string>& parts) {
    BvhOptions options;
    change(options);
    expect_bad_input([&] { rig_from(bvh_files::small, options); }, parts);
  };
  for (const double scale : {0.0, -1.0, std::nan(""), HUGE_VAL})
    refuse([&](BvhOptions& o) { o.scale = scale; }, {"scale", "; "});
  for (const double rate : {-1.0, std::nan(""), HUGE_VAL})
    refuse([&](BvhOptions& o) { o.rate = rate; }, {"rate", "; "});
  for (const char* up : {"", "Y", "w", "--y", "y ", "-"})
    refuse([&](BvhOptions& o) { o.up = up; }, {"up", "; "});
  refuse([](BvhOptions& o) { o.forward = "-y"; }, {"one line", "; "});
  refuse([](BvhOptions& o) { o.start = 3; }, {"3 to 2", "0 to 2", "; "});
  refuse([](BvhOptions& o) { o.start = -1; }, {"-1 to 2", "; "});
  refuse([](BvhOptions& o) { o.end = 3; }, {"0 to 3", "; "});
  refuse([](BvhOptions& o) { o.end = -2; }, {"0 to -2", "; "});
  refuse([](BvhOptions& o) { o.rate = 1e8; }, {"2.5e+07 keys", "3 joints", "; "});
  refuse([](BvhOptions& o) { o.rate = 1e300; }, {"keys", "; "});
}

}  // namespace sinew::rig_test

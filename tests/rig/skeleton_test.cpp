// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/rig/skeleton.h>

#include <gtest/gtest.h>

#include <sinew/scene/rig.h>

#include "support/expect_error.h"
#include "support/world.h"

namespace sinew::skeleton_test {

using test::expect_bad_input;

/// Two bones along z; every value was read at a line of its own.
Settings two_bones() {
  Settings settings;
  settings.bones = {{"lower", "", Vec3(0, 0, 0), Vec3(0, 0, 1)},
                    {"upper", "lower", {}, Vec3(0, 0, 3)}};
  settings.places = {{"skeleton", {"s.yaml", 1, 1}}};
  for (int bone = 0; bone < 2; ++bone)
    for (const auto& [key, line] : {std::pair("name", 1), {"parent", 2}, {"head", 3}, {"tail", 4}})
      settings.places["skeleton.bones[" + std::to_string(bone) + "]." + key] = {
          "s.yaml", 10 * bone + line, 7};
  return settings;
}

void expect_refused(const Settings& settings, const std::vector<std::string>& parts) {
  expect_bad_input([&] { skeleton_of(settings); }, parts);
}

TEST(Skeleton, PutsAHeadOnItsParentsTail) {
  const Skeleton skeleton = skeleton_of(two_bones());
  ASSERT_EQ(skeleton.size(), 2u);
  const Bone& upper = skeleton.bones[1];
  EXPECT_EQ(upper.parent, 0);
  EXPECT_EQ(skeleton.bones[0].parent, no_bone);
  EXPECT_EQ(upper.head(), Vec3(0, 0, 1));
  EXPECT_EQ(upper.tail(), Vec3(0, 0, 3));
  EXPECT_DOUBLE_EQ(upper.length, 2);
  EXPECT_EQ(upper.axis(), Vec3::UnitZ());
}

TEST(Skeleton, FramesAreRightHandedForEveryDirection) {
  std::mt19937 random(1);
  std::vector<Vec3> axes = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ(), -Vec3::UnitZ(),
                            {1, 1, 0},     {1, 1, 1},     {1e-9, 1, 0},  {1e-100, 0, 0}};
  for (int i = 0; i < 100; ++i) axes.push_back(test::random_vector(random));
  for (const Vec3& axis : axes) {
    const Mat3 frame = frame_along(axis);
    EXPECT_LT((frame.transpose() * frame - Mat3::Identity()).norm(), 1e-14);
    EXPECT_NEAR(frame.determinant(), 1, 1e-14);
    EXPECT_LT((frame.col(0) - axis.stableNormalized()).norm(), 1e-15);
  }
}

TEST(Skeleton, RoundingSwapsNoSidesOfAFrame) {
  const std::vector<Vec3> axes = {Vec3::UnitX(), Vec3::UnitY(), -Vec3::UnitZ(), {1, 1, 0},
                                  {1, 0, -1},    {1, 1, 1},     {3, -3, 3},     {2, 1, 1}};
  for (const Vec3& axis : axes)
    for (int other = 0; other < 27; ++other) {
      const Vec3 residue(other % 3 - 1, other / 3 % 3 - 1, other / 9 - 1);
      EXPECT_LT((frame_along(axis + 1e-15 * residue) - frame_along(axis)).norm(), 1e-14)
          << axis.transpose() << " and " << residue.transpose();
    }
}

TEST(Skeleton, TakesLengthAndDirectionInPlaceOfATail) {
  Settings settings = two_bones();
  settings.bones[1].tail.reset();
  settings.bones[1].length = 0.5;
  EXPECT_EQ(skeleton_of(settings).bones[1].tail(), Vec3(0, 0, 1.5)) << "the parent's direction";
  settings.bones[1].direction = Vec3(0, 8, 0);
  EXPECT_EQ(skeleton_of(settings).bones[1].tail(), Vec3(0, 0.5, 1));
}

TEST(Skeleton, RollTurnsTheSidesAboutTheBone) {
  for (const double roll : {-30.0, 90.0, 200.0}) {
    Settings settings = two_bones();
    const Mat3 flat = skeleton_of(settings).bones[1].rest.rotation;
    settings.bones[1].roll = roll;
    const Mat3 rolled = skeleton_of(settings).bones[1].rest.rotation;
    EXPECT_LT((rolled - test::turned(Vec3::UnitZ(), roll) * flat).norm(), 1e-14);
  }
}

TEST(Skeleton, RefusesTwoOrHalfTails) {
  Settings both = two_bones(), none = both, half = both, flat = both;
  both.bones[1].length = 1;
  none.bones[1].tail.reset();
  half.bones[0].tail.reset();
  half.bones[0].length = 1;
  flat.bones[1].tail.reset();
  flat.bones[1].length = 1;
  flat.bones[1].direction = Vec3::Zero();
  expect_refused(both, {"'upper'", "tail already", "; "});
  expect_refused(none, {"bones[1].tail is missing", "; "});
  expect_refused(half, {"'lower'", "no direction", "; "});
  expect_refused(flat, {"'upper'", "direction of no length", "; "});
}

TEST(Skeleton, RefusesConnectionsThatContradict) {
  Settings headed = two_bones(), orphan = headed, loose = headed;
  headed.bones[1].connected = true;
  headed.bones[1].head = Vec3(0, 0, 1);
  orphan.bones[0].connected = true;
  orphan.bones[0].head.reset();
  loose.bones[1].connected = false;
  expect_refused(headed, {"'upper'", "a head of its own", "; "});
  expect_refused(orphan, {"'lower'", "no parent", "; "});
  expect_refused(loose, {"'upper'", "not connected", "; "});
}

TEST(Skeleton, RefusesATwistLimitWithLowAboveHigh) {
  Settings settings = two_bones();
  settings.bones[1].limits.twist = {10, -10};
  expect_refused(settings, {"'upper'", "10", "-10", "; "});
}

TEST(Skeleton, RefusesANameUsedTwice) {
  Settings settings = two_bones();
  settings.bones[1].name = "lower";
  expect_refused(settings, {"s.yaml:11:7: ", "'lower'", "; "});
}

TEST(Skeleton, RefusesAnUnknownOrLaterOrOwnParent) {
  for (const char* parent : {"lowre", "upper"}) {
    Settings settings = two_bones();
    settings.bones[1].parent = parent;
    expect_refused(settings, {"s.yaml:12:7: ", parent, "; "});
  }
  Settings settings = two_bones();
  settings.bones[0].parent = "upper";
  expect_refused(settings, {"s.yaml:2:7: ", "'upper'", "; "});
}

TEST(Skeleton, RefusesARootWithoutHead) {
  Settings settings = two_bones();
  settings.bones[0].head.reset();
  expect_refused(settings, {"s.yaml:1:7: ", "'lower'", "head", "; "});
}

TEST(Skeleton, RefusesBonesWithoutLength) {
  for (const Vec3& tail : {Vec3(0, 0, 1), Vec3(1e-200, 0, 1)}) {
    Settings settings = two_bones();
    settings.bones[1].tail = tail;
    expect_refused(settings, {"s.yaml:14:7: ", "'upper'", "no length", "; "});
  }
  Settings settings = two_bones();
  settings.bones[1].tail = Vec3(0, std::nan(""), 0);
  expect_refused(settings, {"s.yaml:14:7: ", "'upper'"});
}

TEST(Skeleton, RefusesToHaveNoBones) {
  Settings settings = two_bones();
  settings.bones.clear();
  expect_refused(settings, {"s.yaml:1:1: ", "bones", "; "});
}

}  // namespace sinew::skeleton_test

// SPDX-License-Identifier: GPL-3.0-or-later
#include "rig/skeleton.h"

#include <gtest/gtest.h>

#include "expect_error.h"
#include "world.h"

namespace sinew {
namespace {

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
  expect_bad_input([&] { make_skeleton(settings); }, parts);
}

TEST(Skeleton, PutsAHeadOnItsParentsTail) {
  const Skeleton skeleton = make_skeleton(two_bones());
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

}  // namespace
}  // namespace sinew

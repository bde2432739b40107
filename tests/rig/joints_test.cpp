// SPDX-License-Identifier: GPL-3.0-or-later
// The bones made from joints: heads at the joints, tails by one rule, unique names.
#include <gtest/gtest.h>
#include <cmath>

#include <sinew/rig/skeleton.h>

#include "support/expect_error.h"

namespace sinew::joints_test {

using test::expect_bad_input;

/// A root at the origin, and children of it at `places`.
std::vector<Joint> star(const Points& places) {
  std::vector<Joint> joints = {{"root", no_bone, Vec3::Zero(), {}}};
  for (const Vec3& place : places)
    joints.push_back({std::to_string(joints.size()), 0, place, place + Vec3(0, 0, 1)});
  return joints;
}

Vec3 root_tail(const std::vector<Joint>& joints) { return skeleton_of(joints).bones[0].tail(); }

void expect_near(const Vec3& a, const Vec3& b) {
  EXPECT_LT((a - b).norm(), 1e-14) << a.transpose() << " and " << b.transpose();
}

TEST(Joints, BonesEndAtTheOnlyChildOrAtTheMeanOfSeveral) {
  expect_near(root_tail(star({{1, 2, 3}})), {1, 2, 3});
  expect_near(root_tail(star({{1, 2, 3}, {3, 2, 1}, {2, -1, 2}})), {2, 1, 2});
}

TEST(Joints, BonesEndWhereTheFileSays) {
  std::vector<Joint> joints = star({{1, 2, 3}});
  joints[0].end = Vec3(0, 2, 0);
  const Skeleton skeleton = skeleton_of(joints);
  expect_near(skeleton.bones[0].tail(), {0, 2, 0});
  expect_near(skeleton.bones[1].tail(), {1, 2, 4});
}

TEST(Joints, ChildrenThatCancelLeaveTheFarthestOne) {
  expect_near(root_tail(star({{1, 0, 0}, {-3, 0, 0}, {2, 0, 0}})), {-3, 0, 0});
  expect_near(root_tail(star({{1, 0, 0}, {-1 + 1e-9, 0, 0}})), {1, 0, 0});
}

TEST(Joints, BonesWithoutAnyEndFollowTheirParent) {
  std::vector<Joint> joints = star({{0, 2, 0}});
  joints[1].end = {};
  joints.push_back({"inner", 1, Vec3(0, 2, 0), Vec3(0, 2, 1e-9)});
  const Skeleton skeleton = skeleton_of(joints);
  expect_near(skeleton.bones[1].tail(), {0, 2.2, 0});
  expect_near(skeleton.bones[2].tail(), {0, 2.02, 0});
}

TEST(Joints, RootsWithoutAnyEndPointUp) {
  std::vector<Joint> joints = star({});
  joints.push_back({"far", no_bone, Vec3(3, 4, 0), {}});
  expect_near(root_tail(joints), {0, 0, 0.5});
}

TEST(Joints, ManyInOnePlaceStillHaveLength) {
  std::vector<Joint> joints = star({{1, 0, 0}});
  for (int i = 1; i < 150; ++i) joints.push_back({"", i, Vec3(1, 0, 0), {}});
  joints[1].end = {};
  for (const Bone& bone : skeleton_of(joints).bones) EXPECT_GE(bone.length, 1e-6);
}

TEST(Joints, FramesAreRightHandedAndBeginWithTheAxis) {
  for (const Bone& bone : skeleton_of(star({{1, 2, 3}, {0, 0, -1}, {-2, 5, 0}})).bones) {
    EXPECT_LT((bone.rest.rotation.transpose() * bone.rest.rotation - Mat3::Identity()).norm(),
              1e-14);
    EXPECT_NEAR(bone.rest.rotation.determinant(), 1, 1e-14);
  }
}

TEST(Joints, EachGetsANameOfItsOwn) {
  std::vector<Joint> joints = star(Points(6, Vec3(1, 0, 0)));
  const char* given[] = {"a", "a", "a_2", "", "a", "joint_3", ""};
  const char* expected[] = {"a", "a_3", "a_2", "joint_3_", "a_4", "joint_3", "joint_6"};
  for (std::size_t i = 0; i < joints.size(); ++i) joints[i].name = given[i];
  const Skeleton skeleton = skeleton_of(joints);
  for (std::size_t i = 0; i < joints.size(); ++i) EXPECT_EQ(skeleton.bones[i].name, expected[i]);
}

TEST(Joints, RefusesWhatMakesNoSkeleton) {
  expect_bad_input([] { skeleton_of(std::vector<Joint>{}); }, {"no joints", "; "});
  expect_bad_input([] { skeleton_of(star({})); }, {"one point", "; "});
  for (const int parent : {-2, 1, 2, 7}) {
    std::vector<Joint> joints = star({{1, 0, 0}, {2, 0, 0}});
    joints[1].parent = parent;
    expect_bad_input([&] { skeleton_of(joints); }, {"joint 1", "parent", "; "});
  }
  for (const double number : {std::nan(""), HUGE_VAL}) {
    std::vector<Joint> joints = star({{1, 0, 0}});
    joints[1].end = Vec3(0, number, 0);
    expect_bad_input([&] { skeleton_of(joints); }, {"joint 1", "finite", "; "});
  }
}

}  // namespace sinew::joints_test

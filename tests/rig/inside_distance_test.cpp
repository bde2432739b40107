// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/rig/detail/inside_distance.h>

#include <gtest/gtest.h>

#include <sinew/rig/binding.h>
#include <sinew/scene/rig.h>

#include "support/world.h"

namespace sinew::inside_distance_test {

constexpr double r = 0.01;
const double half_width = 2 * half_plane_spacing(r);  // of a finger of five half-planes
const double gap = 1.2 * 2 * r;                       // between the fingers' nearest centers
const double from_middle = half_width + gap / 2;
constexpr double palm_top = 0.11;

void add(Points more, const Vec3& shift, Points& points) {
  for (const Vec3& point : more) points.push_back(point + shift);
}

/// A palm with two fingers side by side, and a crumb that touches nothing.
struct Hand {
  Points rest;
  std::size_t left = 0, right = 0, crumb = 0;  // where each begins

  Hand() {
    rest = test::fcc_box(15, 5, 8, r);
    left = rest.size();
    add(test::fcc_box(5, 5, 31, r), {-from_middle, 0, palm_top}, rest);
    right = rest.size();
    add(test::fcc_box(5, 5, 31, r), {from_middle, 0, palm_top}, rest);
    crumb = rest.size();
    rest.emplace_back(-0.3, 0, 0.3);
  }
};

/// The left finger's bone lies on its far side, the right one's near the gap.
Skeleton bones() {
  Settings settings;
  const double top = palm_top + 31 * half_plane_spacing(r);
  settings.bones = {{"palm", "", Vec3(0, 0, 0), Vec3(0, 0, palm_top)},
                    {"left", "palm", Vec3(-from_middle - 1.3 * r, 0, palm_top),
                     Vec3(-from_middle - 1.3 * r, 0, top)},
                    {"right", "palm", Vec3(from_middle - 1.3 * r, 0, palm_top),
                     Vec3(from_middle - 1.3 * r, 0, top)}};
  return skeleton_of(settings);
}

Binding bound(const Points& rest, bool inside, double joint_zone = 0) {
  BindOptions options;
  options.radius = r;
  options.inside = inside;
  options.joint_zone = joint_zone;
  return bind_to_bones(rest, bones(), options);
}

/// Particles above `height` that the bone of the other finger holds, even in part.
int strangers(const Hand& hand, const Binding& binding, double height) {
  int count = 0;
  for (std::size_t i = hand.left; i < hand.crumb; ++i)
    for (const Influence& influence : binding.of(i))
      count += hand.rest[i].z() > height && influence.bone == (i < hand.right ? 2 : 1);
  return count;
}

TEST(InsideBinding, NeverBindsAFingerToItsNeighborAcrossAGap) {
  const Hand hand;
  EXPECT_GT(strangers(hand, bound(hand.rest, false), 0), 50);  // by straight distance it does
  const Binding binding = bound(hand.rest, true);
  EXPECT_EQ(strangers(hand, binding, 0), 0);
  for (std::size_t i = hand.left; i < hand.crumb; ++i) ASSERT_NE(binding.bone(i), no_bone);
}

TEST(InsideBinding, SharesBetweenFingersNoHigherThanTheJointZone) {
  const Hand hand;
  const Binding binding = bound(hand.rest, true, 1);
  const double width = std::sqrt(std::max(binding.cross_section[1], binding.cross_section[0]));
  EXPECT_EQ(strangers(hand, binding, palm_top + width), 0);
}

TEST(InsideBinding, BindsParticlesWithoutAPathToTheNearestBoneAndCountsThem) {
  const Hand hand;
  const Binding binding = bound(hand.rest, true);
  EXPECT_EQ(binding.unreached, 1u);
  EXPECT_EQ(binding.bone(hand.crumb), 1);
  EXPECT_EQ(bound(hand.rest, false).unreached, 0u);
}

TEST(InsideBinding, IsThatOfTheNearestBoneInAConvexBody) {
  const Points rest = test::fcc_box(11, 11, 49, r);
  const Skeleton skeleton = skeleton_of(test::box_scene());
  BindOptions options;
  options.radius = r;
  options.inside = true;
  const Binding binding = bind_to_bones(rest, skeleton, options);
  for (std::size_t i = 0; i < rest.size(); ++i) {
    EXPECT_EQ(binding.bone(i), nearest_bone(skeleton, rest[i])) << rest[i].transpose();
  }
}

TEST(InsideDistance, IsTheStraightOneInTheOpen) {
  for (const double turn : {0, 25}) {
    const Mat3 turned = test::turned({1, 2, 3}, turn);
    const Points rest = test::affine(test::fcc_box(15, 15, 31, r), turned);
    Skeleton skeleton = skeleton_of(test::box_scene(31));
    skeleton = placed(skeleton, Placement{1, turned});
    const auto near = near_inside(inside_paths(rest, skeleton, r), skeleton, r);
    for (std::size_t i = 0; i < rest.size(); ++i)
      for (const BoneDistance& one : near[i]) {
        const double straight = distance_to(skeleton.bones[one.bone], rest[i]);
        // Paths begin at particles, not on the bone itself; along the surface they lack a side.
        EXPECT_GE(one.distance, straight);
        EXPECT_LE(one.distance, 1.08 * straight + 0.5 * r);
      }
  }
}

TEST(InsideDistance, GoesAroundAGap) {
  const Hand hand;
  const Skeleton skeleton = bones();
  const auto near = near_inside(inside_paths(hand.rest, skeleton, r), skeleton, 1);
  for (std::size_t i = hand.left; i < hand.right; ++i)
    for (const BoneDistance& one : near[i])
      if (one.bone == 2) {
        EXPECT_GE(one.distance, 0.9 * (hand.rest[i].z() - palm_top));
      }
}

TEST(InsideDistance, NearOnesAreThoseWithinReach) {
  const Hand hand;
  const Skeleton skeleton = bones();
  const auto near = near_inside(inside_paths(hand.rest, skeleton, r), skeleton, 4 * r);
  for (std::size_t i = 0; i < hand.crumb; ++i) {
    const BoneDistance nearest = nearest_of(near[i]);
    ASSERT_NE(nearest.bone, no_bone);
    for (const BoneDistance& one : near[i])
      EXPECT_LE(one.distance, 1.13 * nearest.distance + 4.5 * r);
  }
  EXPECT_TRUE(near[hand.crumb].empty());
}

}  // namespace sinew::inside_distance_test

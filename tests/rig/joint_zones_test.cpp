// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/rig/detail/joint_zones.h>

#include <gtest/gtest.h>
#include <algorithm>
#include <numeric>
#include <random>

#include <sinew/rig/binding.h>
#include <sinew/scene/rig.h>

#include "support/world.h"

namespace sinew::joint_zones_test {

constexpr double zone = 0.2;  // m
constexpr double step = 1e-5;

Skeleton skeleton_of(std::vector<BoneDefinition> bones) {
  Settings settings;
  settings.bones = std::move(bones);
  return skeleton_of(settings);
}

/// Weights by bone.
std::vector<double> weights_at(const Skeleton& skeleton, const JointZones& zones,
                               const Vec3& point) {
  std::vector<double> weights(skeleton.size(), 0.0);
  const auto distance = [&](int bone) { return distance_to(skeleton.bones[bone], point); };
  for (const BoneWeight& one :
       weights_in_zones(zones, nearest_bone(skeleton, point), point, distance))
    weights[one.bone] += one.weight;
  return weights;
}

/// The largest change of any weight over one step along lines through a ball around `center`.
double largest_change(const Skeleton& skeleton, const Vec3& center, double radius) {
  const JointZones zones =
      joint_zones(skeleton, std::vector<double>(skeleton.size(), zone * zone), 1);
  std::mt19937 random(3);
  double most = 0;
  for (int line = 0; line < 30; ++line) {
    const Vec3 direction = test::random_vector(random).normalized();
    const Vec3 middle = center + radius * test::random_vector(random);
    std::vector<double> before;
    for (double s = -radius / 2; s < radius / 2; s += step) {
      const auto weights = weights_at(skeleton, zones, middle + s * direction);
      for (std::size_t b = 0; b < before.size(); ++b)
        most = std::max(most, std::abs(weights[b] - before[b]));
      before = weights;
    }
  }
  return most;
}

// Weights rise by 1 over a zone; where several meet, and near the zone's end, by a few times that.
constexpr double smooth = 40 * step / zone;

TEST(JointZones, WeightsDoNotJumpWhereOneBoneHasTwoChildren) {
  const Skeleton fork = skeleton_of({{"trunk", "", Vec3(0, 0, -0.4), Vec3(0, 0, 0)},
                                     {"left", "trunk", {}, Vec3(-0.3, 0, 0.3)},
                                     {"right", "trunk", {}, Vec3(0.3, 0, 0.3)}});
  EXPECT_LT(largest_change(fork, {0, 0, 0}, 0.06), smooth);
}

TEST(JointZones, WeightsDoNotJumpWhereHeadsLieBesideTheParent) {
  const Skeleton hips = skeleton_of({{"pelvis", "", Vec3(0, 0, 0), Vec3(0, 0, 0.2)},
                                     {"spine", "pelvis", {}, Vec3(0, 0.02, 0.6)},
                                     {"left", "pelvis", Vec3(0.1, 0, 0), Vec3(0.1, 0, -0.4)},
                                     {"right", "pelvis", Vec3(-0.1, 0, 0), Vec3(-0.1, 0, -0.4)}});
  EXPECT_LT(largest_change(hips, {0.05, 0, -0.02}, 0.06), smooth);
  EXPECT_LT(largest_change(hips, {0, 0, 0.2}, 0.06), smooth);
}

TEST(JointZones, WeightsDoNotJumpOnAShortBoneBetweenTwoJoints) {
  const Skeleton finger = skeleton_of({{"a", "", Vec3(0, 0, 0), Vec3(0, 0, 0.3)},
                                       {"b", "a", {}, Vec3(0, 0, 0.35)},
                                       {"c", "b", {}, Vec3(0, 0, 0.7)}});
  EXPECT_LT(largest_change(finger, {0, 0, 0.32}, 0.2), 40 * step / 0.05);
}

/// Each is compared with each: of 3,000 they would be a day's work for a large body.
TEST(JointZones, OfVeryManyChildrenTheNearestHundredShareAPoint) {
  std::vector<BoneDefinition> bones = {{"trunk", "", Vec3(0, 0, -0.4), Vec3(0, 0, 0)}};
  for (int i = 0; i < 1000; ++i)
    bones.push_back({"child " + std::to_string(i), "trunk", {}, Vec3(0, 0, 0.4)});
  const Skeleton broom = skeleton_of(std::move(bones));
  const JointZones zones = joint_zones(broom, std::vector<double>(broom.size(), zone * zone), 1);
  const std::vector<double> weights = weights_at(broom, zones, {0.02, 0, 0.05});
  EXPECT_LE(std::count_if(weights.begin(), weights.end(), [](double one) { return one > 0; }), 101);
  EXPECT_NEAR(std::accumulate(weights.begin(), weights.end(), 0.0), 1, 1e-12);
}

TEST(JointZones, AHeadApartFromTheParentsTailHasAZone) {
  const Skeleton arm = skeleton_of({{"upper", "", Vec3(0, 0, 0), Vec3(0, 0, 0.3)},
                                    {"lower", "upper", Vec3(0, 0.01, 0.31), Vec3(0, 0.01, 0.6)}});
  const JointZones zones = joint_zones(arm, {zone * zone, zone * zone}, 1);
  EXPECT_TRUE(zones.above[1].across_axis);
  const auto weights = weights_at(arm, zones, {0, 0.01, 0.31});  // at the child's head
  EXPECT_NEAR(weights[0], 0.5, 1e-12);
  EXPECT_NEAR(weights[1], 0.5, 1e-12);
}

TEST(JointZones, EndWhereEachChildHasItsOwn) {
  const Skeleton legs = skeleton_of({{"pelvis", "", Vec3(0, 0, 0.2), Vec3(0, 0, 0)},
                                     {"left", "pelvis", Vec3(0.04, 0, 0), Vec3(0.04, 0, -0.6)},
                                     {"right", "pelvis", Vec3(-0.04, 0, 0), Vec3(-0.04, 0, -0.6)}});
  const JointZones zones = joint_zones(legs, std::vector<double>(3, zone * zone), 1);
  const auto weights = weights_at(legs, zones, {0.01, 0, -0.3});
  EXPECT_EQ(weights[1], 1);
  EXPECT_EQ(weights[2], 0);
}

TEST(JointZones, WithoutLengthThereAreNone) {
  const Skeleton skeleton = skeleton_of(test::box_scene());
  const JointZones zones = joint_zones(skeleton, {0.01, 0.01}, 0);
  EXPECT_EQ(zones.longest(), 0);
  EXPECT_EQ(weights_at(skeleton, zones, skeleton.bones[1].head()), (std::vector<double>{1, 0}));
}

}  // namespace sinew::joint_zones_test

// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/rig/binding.h>

#include <gtest/gtest.h>
#include <numeric>

#include <sinew/core/parallel.h>
#include <sinew/scene/rig.h>

#include "support/world.h"

namespace sinew::binding_test {

constexpr double r = 0.01;
const double V0 = volume_per_particle(r);

Points box() { return test::fcc_box(11, 11, 49, r); }
Skeleton two_bones() { return skeleton_of(test::box_scene()); }

double weight_of(const Binding& binding, std::size_t i, int bone) {
  for (const Influence& influence : binding.of(i))
    if (influence.bone == bone) return influence.weight;
  return 0;
}

TEST(NearestBone, IsTheNearestSegmentAndTheLowerIndexOnTies) {
  Settings settings;
  settings.bones = {{"a", "", Vec3(0, 0, 0), Vec3(0, 0, 1)},
                    {"b", "a", {}, Vec3(0, 0, 2)},
                    {"c", "", Vec3(3, 0, 0), Vec3(3, 0, 1)}};
  const Skeleton skeleton = skeleton_of(settings);
  const std::pair<Vec3, int> cases[] = {{{0.4, 0, 0.3}, 0}, {{0.4, 0, 1.3}, 1}, {{0, 0, -9}, 0},
                                        {{0, 0, 9}, 1},     {{2.9, 5, 0}, 2},   {{0.2, 0.1, 1}, 0},
                                        {{1.5, 0, 0.5}, 0}, {{1.5, 2, 0.5}, 0}};
  for (const auto& [point, bone] : cases)
    EXPECT_EQ(nearest_bone(skeleton, point), bone) << point.transpose();
}

TEST(Binding, WithoutAZoneGivesEachParticleToOneBone) {
  const Points rest = box();
  const Skeleton skeleton = two_bones();
  const Binding binding = bind_to_bones(rest, skeleton, V0, 0);
  for (std::size_t i = 0; i < rest.size(); ++i) {
    ASSERT_EQ(binding.of(i).size(), 1u);
    const Influence& influence = binding.of(i)[0];
    EXPECT_EQ(influence.weight, 1);
    EXPECT_EQ(influence.bone, nearest_bone(skeleton, rest[i]));
    EXPECT_LT((influence.foot_on(skeleton.bones[influence.bone]) - Vec3(0, 0, rest[i].z())).norm(),
              1e-15);
    EXPECT_DOUBLE_EQ(influence.distance_to(skeleton.bones[influence.bone], rest[i]),
                     std::hypot(rest[i].x(), rest[i].y()));
  }
}

TEST(Binding, FeetOfParticlesBeyondTheEndsAreTheEnds) {
  const Skeleton skeleton = two_bones();
  const Binding binding = bind_to_bones({{0.1, 0, -0.5}, {0.1, 0, 5}}, skeleton, V0, 0);
  EXPECT_EQ(binding.of(0)[0].foot, 0);
  EXPECT_LT((binding.of(1)[0].foot_on(skeleton.bones[1]) - skeleton.bones[1].tail()).norm(), 1e-15);
  EXPECT_DOUBLE_EQ(binding.of(0)[0].distance_to(skeleton.bones[0], {0.1, 0, -0.5}),
                   std::hypot(0.1, 0.5));
}

TEST(Binding, CrossSectionIsVolumeBoundOverLength) {
  const Points rest = box();
  const Skeleton skeleton = two_bones();
  const double length = skeleton.bones[0].length;
  const Binding sharp = bind_to_bones(rest, skeleton, V0, 0);
  double lower = 0;
  for (std::size_t i = 0; i < rest.size(); ++i) lower += sharp.bone(i) == 0;
  EXPECT_NEAR(sharp.cross_section[0], lower * V0 / length, 1e-14);
  EXPECT_NEAR(sharp.cross_section[1], (rest.size() - lower) * V0 / length, 1e-14);
  // A zone shares the middle plane evenly: half of all weights are of either bone.
  const Binding zoned = bind_to_bones(rest, skeleton, V0, 3);
  EXPECT_NEAR(zoned.cross_section[0], rest.size() * V0 / (2 * length), 1e-13);
  EXPECT_NEAR(zoned.cross_section[0], zoned.cross_section[1], 1e-13);
}

TEST(Binding, WeightsPassLinearlyOverTheJointZone) {
  const Points rest = box();
  const Skeleton skeleton = two_bones();
  const double joint = skeleton.bones[1].head().z();
  // Both bones have the same length: the mean of their sections is that of the whole body.
  const double zone = 2 * std::sqrt(rest.size() * V0 / (2 * joint));
  const Binding binding = bind_to_bones(rest, skeleton, V0, 2);
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const double upper = std::clamp(0.5 + (rest[i].z() - joint) / zone, 0.0, 1.0);
    EXPECT_NEAR(weight_of(binding, i, 1), upper, 1e-12);
    EXPECT_NEAR(weight_of(binding, i, 0), 1 - upper, 1e-12);
    for (const Influence& influence : binding.of(i))  // on the axis, extended within the zone
      EXPECT_LT(
          (influence.foot_on(skeleton.bones[influence.bone]) - Vec3(0, 0, rest[i].z())).norm(),
          1e-14);
  }
}

/// A trunk with two branches, a bend, and a bone that is attached to the tip without touching it.
Skeleton tree() {
  Settings settings;
  settings.bones = {{"trunk", "", Vec3(0, 0, 0), Vec3(0, 0, 0.3)},
                    {"left", "trunk", {}, Vec3(-0.2, 0, 0.5)},
                    {"right", "trunk", {}, Vec3(0.2, 0, 0.5)},
                    {"tip", "right", {}, Vec3(0.4, 0.1, 0.5)},
                    {"loose", "tip", Vec3(0, 0.4, 0), Vec3(0, 0.4, 0.2)}};
  return skeleton_of(settings);
}

Points cloud() {
  std::mt19937 random(4);
  Points points;
  for (int i = 0; i < 3000; ++i) points.push_back(test::random_vector(random) + Vec3(0, 0, 0.3));
  return points;
}

TEST(Binding, WeightsArePositiveSumToOneAndBeginWithTheHeaviest) {
  const Points rest = cloud();
  for (const double zone : {0.0, 0.3, 1.0, 3.0}) {
    const Skeleton skeleton = tree();
    const Binding binding = bind_to_bones(rest, skeleton, 1e-5, zone);
    for (std::size_t i = 0; i < rest.size(); ++i) {
      const auto influences = binding.of(i);
      ASSERT_FALSE(influences.empty());
      EXPECT_EQ(binding.bone(i), influences[0].bone);
      double sum = 0;
      for (const Influence& one : influences) {
        EXPECT_GT(one.weight, 0);
        EXPECT_LE(one.weight, influences[0].weight);
        sum += one.weight;
      }
      EXPECT_NEAR(sum, 1, 1e-12);
    }
  }
}

TEST(Binding, CrossSectionsAccountForAllVolume) {
  for (const double zone : {0.0, 0.3, 3.0}) {
    const Skeleton skeleton = tree();
    const Binding binding = bind_to_bones(cloud(), skeleton, 1e-5, zone);
    double volume = 0;
    for (std::size_t b = 0; b < skeleton.size(); ++b)
      volume += binding.cross_section[b] * skeleton.bones[b].length;
    EXPECT_NEAR(volume, 3000 * 1e-5, 1e-12);
  }
}

TEST(Binding, BonesThatDoNotTouchShareNoParticle) {
  const Points rest = {{0, 0.4, 0.1}, {0, 0.4, 0}, {0, 0.4, 0.2}};
  const Binding binding = bind_to_bones(rest, tree(), 1e-5, 3);
  for (std::size_t i = 0; i < rest.size(); ++i) {
    ASSERT_EQ(binding.of(i).size(), 1u);
    EXPECT_EQ(binding.bone(i), 4);
  }
}

BindOptions options_of(double joint_zone = 0) {
  BindOptions options;
  options.radius = r;
  options.joint_zone = joint_zone;
  return options;
}

TEST(Binding, OfACoreLeavesFartherParticlesFree) {
  const Points rest = box();
  BindOptions options = options_of(1);
  options.core_radius = 3 * r;
  const Skeleton skeleton = two_bones();
  const Binding binding = bind_to_bones(rest, skeleton, options);
  double in_core = 0;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const bool core = std::hypot(rest[i].x(), rest[i].y()) <= 3 * r;
    EXPECT_EQ(binding.bone(i) != no_bone, core);
    EXPECT_EQ(binding.weight(i) > 0, core);
    in_core += core;
  }
  ASSERT_GT(in_core, 0);
  const double volume = binding.cross_section[0] * skeleton.bones[0].length +
                        binding.cross_section[1] * skeleton.bones[1].length;
  EXPECT_NEAR(volume, in_core * V0, 1e-12);
}

TEST(Binding, OfRegionsGoesBeforeAllElseAndTheLastCounts) {
  const Points rest = box();
  BindOptions options = options_of();
  BoundRegion by_number, in_box, in_ball;
  by_number.bone = 1;
  by_number.ids = {0, 5};
  in_box.bone = 0;
  in_box.box = Box(Vec3(-1, -1, 0.5), Vec3(1, 1, 1));
  in_ball.center = rest[5];
  in_ball.radius = r;
  options.regions = {by_number, in_box, in_ball};
  const Binding binding = bind_to_bones(rest, two_bones(), options);
  EXPECT_EQ(binding.bone(0), 1);
  EXPECT_EQ(binding.bone(5), no_bone);  // the ball's
  for (std::size_t i = 6; i < rest.size(); ++i) {
    const int nearest = nearest_bone(two_bones(), rest[i]);
    EXPECT_EQ(binding.bone(i), rest[i].z() >= 0.5 ? 0 : nearest);
  }
}

TEST(Binding, TakesGivenWeights) {
  const Points rest = {{0.1, 0, 0.1}, {0.1, 0, 0.5}};
  BindOptions options = options_of(1);
  options.weights = BoneWeights{{0, 2, 2}, {{1, 0.75}, {0, 0.25}}};
  const Binding binding = bind_to_bones(rest, two_bones(), options);
  EXPECT_EQ(weight_of(binding, 0, 1), 0.75);
  EXPECT_EQ(weight_of(binding, 0, 0), 0.25);
  EXPECT_EQ(binding.bone(1), nearest_bone(two_bones(), rest[1]));  // it has none
}

TEST(Binding, HasTheSameBitsForEveryThreadCount) {
  const Points rest = test::fcc_box(21, 21, 49, r);  // several pieces
  const Binding expected = bind_to_bones(rest, two_bones(), V0, 1);
  for (const int threads : {1, 2, 3, 8})
    with_threads(threads, [&] {
      const Binding found = bind_to_bones(rest, two_bones(), V0, 1);
      EXPECT_EQ(found.first, expected.first);
      EXPECT_EQ(found.cross_section, expected.cross_section);
      ASSERT_EQ(found.influences.size(), expected.influences.size());
      for (std::size_t k = 0; k < found.influences.size(); ++k) {
        ASSERT_EQ(found.influences[k].bone, expected.influences[k].bone);
        ASSERT_EQ(found.influences[k].weight, expected.influences[k].weight);
        ASSERT_EQ(found.influences[k].foot, expected.influences[k].foot);
      }
    });
}

TEST(Binding, OfNoParticlesHoldsNothing) {
  const Binding binding = bind_to_bones({}, two_bones(), V0, 3);
  EXPECT_EQ(binding.first, std::vector<std::uint32_t>{0});
  EXPECT_EQ(binding.cross_section, (std::vector<double>{0, 0}));
}

}  // namespace sinew::binding_test

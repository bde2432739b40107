// SPDX-License-Identifier: GPL-3.0-or-later
// Parts that follow their bones rigidly, bones that pull less, joints that a first motion shows.
#include <sinew/scene/rigid_parts.h>

#include <gtest/gtest.h>

#include <cmath>

#include <sinew/core/text.h>
#include <sinew/scene/new/new_scene.h>
#include <sinew/world/world.h>
#include "support/world.h"

namespace sinew::thin_parts_test {

constexpr double r = 0.01;

/// Layers of closest packing on z, so wide that no border counts in their middle.
Points layers_of(int layers) {
  Points rest;
  const double high = std::sqrt(8.0 / 3) * r, row = std::sqrt(3.0) * r;
  for (int k = 0; k < layers; ++k)
    for (int j = -12; j <= 12; ++j)
      for (int i = -12; i <= 12; ++i)
        rest.emplace_back(2 * r * i + r * ((j + 100) % 2 + k % 2), row * (j + (k % 2) / 3.0),
                          high * k);
  return rest;
}

Body body_of(const Points& rest) { return test::make_body(test::box_scene(15), rest); }

double across_middle(const Body& body) {
  const std::vector<double> across = particles_across(body);
  double nearest = 1e9, value = 0;
  for (std::size_t i = 0; i < across.size(); ++i)
    if (const double far = body.rest[i].head<2>().norm(); far < nearest)
      nearest = far, value = across[i];
  return value;
}

TEST(ThinParts, AreAsManyParticlesAcrossAsTheyHaveLayers) {
  for (const int layers : {1, 2, 3, 4})
    EXPECT_NEAR(across_middle(body_of(layers_of(layers))), layers, 0.1 * layers) << layers;
  EXPECT_GT(across_middle(body_of(layers_of(12))), 5);
}

TEST(ThinParts, AreHeldToTheirBonesWhichPullNoMore) {
  BindingOptions binding;
  binding.rigid_below = 2;
  Body thin = body_of(layers_of(1)), thick = body_of(layers_of(3));
  hold_rigid_parts(binding, thin);
  hold_rigid_parts(binding, thick);
  ASSERT_TRUE(thin.world);
  EXPECT_EQ(thin.world->pins.size(), thin.rest.size());
  for (const Pinned& pin : thin.world->pins) EXPECT_EQ(pin.bone, thin.binding.bone(pin.particle));
  for (const BoneSprings& springs : thin.springs) EXPECT_EQ(springs.stiffest(), 0);
  EXPECT_FALSE(thick.world);
  EXPECT_FALSE(thin_part_notes(binding, thin, 1e-4).empty());
}

TEST(ThinParts, OfFewParticlesPullAsIfTheyHadMore) {
  const Settings settings = test::box_scene(15);
  const Body body = body_of(layers_of(3));
  BindingOptions softer = settings.binding;
  softer.soften_below = 4 * static_cast<double>(body.rest.size());
  const auto usual = bone_springs(settings.binding, body.material, body.binding, body.skeleton);
  const auto soft = bone_springs(softer, body.material, body.binding, body.skeleton);
  for (std::size_t b = 0; b < usual.size(); ++b) {
    const double held = body.binding.cross_section[b] * body.skeleton.bones[b].length /
                        volume_per_particle(body.material.pair.r);
    if (held == 0) continue;
    EXPECT_NEAR(soft[b].radial * softer.soften_below, usual[b].radial * held,
                1e-9 * usual[b].radial * held);
  }
}

/// Two legs beside each other along any axis: neither bends into the other.
TEST(NewJoints, BendWhereThereIsRoom) {
  constexpr double apart = 0.1, high = 0.6;
  for (const Vec3& side : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY()), Vec3(-Vec3::UnitX())}) {
    Settings settings;
    settings.body.radius = r;
    settings.bones = {
        {"hip", "", Vec3(0, 0, high), Vec3(0, 0, 1.3 * high)},
        {"one", "hip", Vec3(apart / 2 * side + high * Vec3::UnitZ()), Vec3(apart / 2 * side)},
        {"other", "hip", Vec3(-apart / 2 * side + high * Vec3::UnitZ()), Vec3(-apart / 2 * side)}};
    Points rest;
    for (const Vec3& at : test::fcc_box(15, 15, 60, r)) {
      const bool leg = at.z() < high && std::abs(std::abs(at.dot(side)) - apart / 2) < 0.03 &&
                       std::abs(at.cross(Vec3::UnitZ()).dot(side)) < 0.03;
      if (leg || at.z() >= high) rest.push_back(at);
    }
    const Body body = test::make_body(settings, rest);
    NewChoices choices;
    bend_joints(body, choices);
    ASSERT_EQ(choices.settings.tracks.size(), 2u);
    for (const TrackDefinition& track : choices.settings.tracks) {
      const double sign = track.bone == "one" ? 1 : -1;
      const KeyDefinition& bent = track.keys[track.keys.size() - 2];
      const Vec3 tail =
          Quat(Eigen::AngleAxisd(radians(*bent.angle), *bent.axis)) * Vec3(0, 0, -high);
      EXPECT_GT(sign * tail.dot(side), -0.01) << track.bone << side.transpose();
    }
  }
}

TEST(NewJoints, AreThoseWithFleshOnBothSides) {
  const Body body = test::make_body(test::box_scene(15), test::fcc_box(7, 7, 15, r));
  for (const int joint : joints_that_skin_follows(body)) {
    EXPECT_NE(body.skeleton.bones[joint].parent, no_bone);
    std::size_t held = 0;
    for (std::size_t i = 0; i < body.rest.size(); ++i) held += body.binding.bone(i) == joint;
    EXPECT_GE(held, 10u);
  }
  NewChoices choices;
  bend_joints(body, choices);
  EXPECT_EQ(choices.settings.tracks.size(), joints_that_skin_follows(body).size());
  double last = -1;
  for (const TrackDefinition& track : choices.settings.tracks) {  // one after the other
    const double begin = *track.keys[track.keys.size() - 3].time;
    EXPECT_GT(begin, last);
    last = begin;
  }
}

}  // namespace sinew::thin_parts_test

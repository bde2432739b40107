// SPDX-License-Identifier: GPL-3.0-or-later
// Bone forces on a whole body whose particles may have several bones, and the reactions on the
// bones.
#include <gtest/gtest.h>
#include <numeric>

#include <sinew/body/body.h>
#include <sinew/body/forces.h>
#include <sinew/core/parallel.h>
#include <sinew/scene/rig.h>

#include "support/world.h"

namespace sinew::bone_forces_test {

constexpr double r = 0.01;

Settings bent_scene(BoneForce form = BoneForce::paper) {
  Settings settings = test::box_scene(25);
  settings.binding.joint_zone = 2;
  settings.binding.force = form;
  KeyDefinition end = test::bend_key(1, 80);
  end.twist = 60;
  end.translation = {0.01, 0.02, 0};
  settings.tracks = {test::track("lower", {test::bend_key(0, 0), test::bend_key(1, -30)}),
                     test::track("upper", {test::bend_key(0, 0), end})};
  return settings;
}

/// A bar in the middle of its motion, its particles shaken.
struct Scene {
  Settings settings;
  Body body;
  Pose pose;
  Particles particles;

  explicit Scene(BoneForce form = BoneForce::paper)
      : settings(bent_scene(form)),
        body(test::make_body(settings, test::fcc_box(7, 7, 25, r))),
        pose(pose_at(body.skeleton, motion_of(settings, body.skeleton), 0.6)),
        particles(test::shaken(body.rest, body.material, r, 0.5)) {}
};

TEST(BoneForces, WithSeveralBonesAreMinusTheGradientOfTheEnergy) {
  for (const BoneForce form : {BoneForce::paper, BoneForce::anchor}) {
    const Scene scene(form);
    Forces forces;
    bone_forces(scene.particles, scene.body, scene.pose, forces);
    int shared = 0;
    const double h = 1e-7;
    for (std::size_t i = 0; i < scene.particles.size(); i += 5) {
      shared += scene.body.binding.of(i).size() > 1;
      for (int axis = 0; axis < 3; ++axis) {
        Particles ahead = scene.particles, behind = scene.particles;
        ahead.set_position(i, ahead.position(i) + h * Vec3::Unit(axis));
        behind.set_position(i, behind.position(i) - h * Vec3::Unit(axis));
        const double slope = (bone_energy(ahead, scene.body, scene.pose) -
                              bone_energy(behind, scene.body, scene.pose)) /
                             (2 * h);
        EXPECT_NEAR(forces.bone[i][axis] - forces.bone_damping[i][axis], -slope, 1e-6);
      }
    }
    EXPECT_GT(shared, 10);
  }
}

TEST(BoneForces, VanishWhenAllMovesWithTheBones) {
  for (const BoneForce form : {BoneForce::paper, BoneForce::anchor}) {
    Settings settings = bent_scene(form);
    settings.tracks.pop_back();  // both bones turn as one
    const Body body = test::make_body(settings, test::fcc_box(7, 7, 25, r));
    const Pose pose = pose_at(body.skeleton, motion_of(settings, body.skeleton), 0.4);
    ASSERT_GT(pose[1].angular_velocity.norm(), 0.1);
    Particles particles = particles_at(body.rest, r, body.material.mass);
    for (std::size_t i = 0; i < particles.size(); ++i) {
      particles.set_position(i, pose[0].turn * body.rest[i]);
      particles.set_velocity(i, pose[0].velocity_at(particles.position(i)));
    }
    Forces forces;
    bone_forces(particles, body, pose, forces);
    for (const Vec3& force : forces.bone) EXPECT_LT(force.norm(), 1e-13);
  }
}

TEST(Reactions, BalanceForceMomentAndPowerOfTheBody) {
  for (const BoneForce form : {BoneForce::paper, BoneForce::anchor}) {
    const Scene scene(form);
    Forces forces;
    bone_forces(scene.particles, scene.body, scene.pose, forces);
    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
    double power = 0, scale = 0, of_bones = 0;
    for (std::size_t i = 0; i < scene.particles.size(); ++i) {
      force += forces.bone[i];
      moment += scene.particles.position(i).cross(forces.bone[i]);
      power += forces.bone_power[i];
      scale += forces.bone[i].norm();
    }
    const auto on = reactions(scene.particles, forces.bone, scene.body, scene.pose);
    for (std::size_t b = 0; b < on.size(); ++b) {
      force += on[b].force;
      moment += on[b].moment + scene.pose[b].frame.origin.cross(on[b].force);
      const double taken = on[b].force.dot(scene.pose[b].velocity) +
                           on[b].moment.dot(scene.pose[b].angular_velocity);
      EXPECT_NEAR(on[b].power, -taken, 1e-13 * scale);
      power += taken;
      of_bones += on[b].power;
    }
    ASSERT_GT(scale, 0.1);
    EXPECT_LT(force.norm(), 1e-13 * scale);
    EXPECT_LT(moment.norm(), 1e-13 * scale);
    EXPECT_NEAR(power, 0, 1e-13 * scale);
    const double entered =  // the sum in the energy ledger
        std::accumulate(forces.bone_power.begin(), forces.bone_power.end(), 0.0);
    EXPECT_NEAR(of_bones, entered, 1e-13 * scale);
  }
}

TEST(Reactions, BelongToTheBoneThatPulls) {
  const Scene scene;
  Particles alone = scene.particles;
  for (std::size_t i = 0; i < alone.size(); ++i) {  // the lower half moves with its bone
    if (scene.body.binding.of(i).size() > 1 || scene.body.binding.bone(i) != 0) continue;
    alone.set_position(
        i, carried(scene.body.rest[i], scene.body.skeleton.bones[0].rest, scene.pose[0].frame));
    alone.set_velocity(i, scene.pose[0].velocity_at(alone.position(i)));
  }
  Forces forces;
  bone_forces(alone, scene.body, scene.pose, forces);
  Vec3 upper = Vec3::Zero(), shared = Vec3::Zero();
  for (std::size_t i = 0; i < alone.size(); ++i)
    (scene.body.binding.of(i).size() > 1 ? shared : upper) += forces.bone[i];
  const auto on = reactions(alone, forces.bone, scene.body, scene.pose);
  EXPECT_LT((on[0].force + on[1].force + upper + shared).norm(), 1e-12);
  // Only the shared particles act on bone 0.
  Vec3 part = Vec3::Zero();
  for (std::size_t i = 0; i < alone.size(); ++i)
    for (const Influence& influence : scene.body.binding.of(i))
      if (influence.bone == 0)
        part +=
            bone_pull(scene.body.springs[0], influence, scene.body.skeleton.bones[0], scene.pose[0],
                      {scene.body.rest[i], alone.position(i), alone.velocity(i), r})
                .force();
  EXPECT_LT((on[0].force + part).norm(), 1e-12);
}

TEST(BoneForces, HaveTheSameBitsForEveryThreadCountAndFollowTheIds) {
  const Scene scene;
  std::vector<std::size_t> order(scene.particles.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = order.size() - 1 - i;
  const Particles other = test::reordered(scene.particles, order);
  Forces forces, reversed;
  bone_forces(scene.particles, scene.body, scene.pose, forces);
  bone_forces(other, scene.body, scene.pose, reversed);
  for (std::size_t i = 0; i < order.size(); ++i) EXPECT_EQ(reversed.bone[i], forces.bone[order[i]]);
  for (const int threads : {1, 2, 3, 8})
    with_threads(threads, [&] {
      Forces again;
      bone_forces(scene.particles, scene.body, scene.pose, again);
      EXPECT_EQ(again.bone, forces.bone);
    });
}

}  // namespace sinew::bone_forces_test

// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/body/bone_force.h>

#include <gtest/gtest.h>

#include <sinew/body/body.h>
#include <sinew/scene/rig.h>

#include "support/world.h"

namespace sinew::bone_force_test {

constexpr double r = 0.01;

/// One bone of length 1 along z, turned and moved, and one particle bound to it.
struct Pull {
  Settings settings;
  Skeleton skeleton;
  Binding binding;
  Material material;
  BoneSprings springs;
  BonePose pose;
  ParticleState particle;

  explicit Pull(const Vec3& rest, BoneForce form = BoneForce::paper) {
    settings = test::box_scene();
    settings.bones = {{"bone", "", Vec3(0.1, 0.2, 0), Vec3(0.1, 0.2, 1)}};
    skeleton = skeleton_of(settings);
    binding = bind_to_bones({rest}, skeleton, 1e-2, 0);
    material = test::material_of(settings);
    springs = {3, 5, 7, 0.2, form, TwistForm::servo};
    pose = rest_pose(skeleton)[0];
    particle = {rest, rest, Vec3::Zero(), r};
  }

  /// Bone and particle turn together by R about the origin, and shift.
  void carry(const Mat3& R, const Vec3& shift) {
    pose.frame.origin = R * pose.frame.origin + shift;
    pose.frame.rotation = R * pose.frame.rotation;
    pose.turn = R * pose.turn;
    particle.position = R * particle.position + shift;
  }

  BonePull at(const Vec3& position) const {
    ParticleState there = particle;
    there.position = position;
    return bone_pull(springs, binding.influences[0], skeleton.bones[0], pose, there);
  }
  BonePull here() const { return at(particle.position); }
};

void keep_only(Pull& pull, double BoneSprings::*spring) {
  BoneSprings kept;
  kept.*spring = pull.springs.*spring;
  pull.springs = kept;
}

/// The force at `position` is minus the slope of the energy there.
void expect_gradient(const Pull& pull, const Vec3& position) {
  const double h = 1e-7;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 shift = h * Vec3::Unit(axis);
    const double slope =
        (pull.at(position + shift).energy - pull.at(position - shift).energy) / (2 * h);
    EXPECT_NEAR(pull.at(position).spring[axis], -slope, 1e-6) << position.transpose();
  }
}

const Vec3 beside = {0.35, 0.1, 0.4};  // rests 0.27 from the bone

TEST(BoneForce, EachSpringIsMinusTheGradientOfItsEnergy) {
  std::mt19937 random(1);
  for (auto spring : {&BoneSprings::radial, &BoneSprings::twist, &BoneSprings::axial}) {
    Pull pull(beside);
    keep_only(pull, spring);
    pull.carry(test::turned({1, 2, 3}, 50), {0.3, 0, 0.1});
    for (int trial = 0; trial < 50; ++trial)
      expect_gradient(pull, pull.particle.position + 0.4 * test::random_vector(random));
  }
}

TEST(BoneForce, AllTogetherAndTheAnchorAreMinusTheGradientOfTheEnergy) {
  std::mt19937 random(2);
  for (const BoneForce form : {BoneForce::paper, BoneForce::anchor}) {
    Pull pull(beside, form);
    pull.carry(test::turned({-1, 2, 0}, 120), {0.3, 0, 0.1});
    for (int trial = 0; trial < 50; ++trial)
      expect_gradient(pull, pull.particle.position + 0.4 * test::random_vector(random));
  }
}

TEST(BoneForce, TwistIsTaperedTowardsTheAxisAndStillAGradient) {
  Pull pull(beside);
  keep_only(pull, &BoneSprings::twist);
  const Vec3 foot(0.1, 0.2, 0.4), across = beside - foot;
  const Mat3 ahead = test::turned(Vec3::UnitZ(), 70);
  for (const double part : {1.5, 0.9, 0.51, 0.49, 0.3, 0.01})
    expect_gradient(pull, foot + part * (ahead * across));
  // U = k rho0^2 alpha^2 s^2 / 2 with s = min(1, 2 rho / rho0)
  const double alpha = radians(70), full = 5 * across.squaredNorm() * alpha * alpha / 2;
  for (const auto& [part, taper] : {std::pair(1.5, 1.0), {0.6, 1.0}, {0.4, 0.8}, {0.1, 0.2}})
    EXPECT_NEAR(pull.at(foot + part * (ahead * across)).energy, full * taper * taper, 1e-12);
  EXPECT_EQ(pull.at(foot).spring, Vec3::Zero()) << "on the axis";
  EXPECT_LT(pull.at(foot + 1e-9 * (ahead * across)).spring.norm(), 1e-6);
}

TEST(BoneForce, AwayFromTheAxisTwistHasItsClosedForm) {
  Pull pull(beside);
  keep_only(pull, &BoneSprings::twist);
  const Vec3 foot(0.1, 0.2, 0.4), rho0 = beside - foot;
  // Linear up to 120 degrees; then a cubic that is half as large at 150 and zero at 180.
  for (const auto& [angle, slope] : {std::pair(-150.0, -60.0),
                                     {-120.0, -120.0},
                                     {-20.0, -20.0},
                                     {1.0, 1.0},
                                     {90.0, 90.0},
                                     {135.0, 120 * (1 - 0.15625)},
                                     {165.0, 120 * 0.15625},
                                     {180.0, 0.0}}) {
    const Vec3 rho = 1.3 * (test::turned(Vec3::UnitZ(), angle) * rho0);
    const Vec3 around = Vec3::UnitZ().cross(rho.normalized());
    const Vec3 expected = -5 * radians(slope) * rho0.squaredNorm() / rho.norm() * around;
    EXPECT_LT((pull.at(foot + rho).spring - expected).norm(), 1e-13) << angle;
  }
}

TEST(BoneForce, TwistHasNoJumpAtHalfATurnAndIsAGradientUpToThere) {
  Pull pull(beside);
  keep_only(pull, &BoneSprings::twist);
  const Vec3 foot(0.1, 0.2, 0.4), rho0 = beside - foot;
  const auto at = [&](double angle) -> Vec3 {
    return foot + 0.8 * (test::turned(Vec3::UnitZ(), angle) * rho0);
  };
  for (const double angle : {115.0, 119.9, 120.1, 140.0, 170.0, 179.0, 180.0, 181.0, 200.0})
    expect_gradient(pull, at(angle));
  EXPECT_LT((pull.at(at(179.9999)).spring - pull.at(at(180.0001)).spring).norm(), 1e-9);
  EXPECT_NEAR(pull.at(at(179.9999)).energy, pull.at(at(180.0001)).energy, 1e-12);
}

TEST(BoneForce, RadialAndAxialHaveTheirClosedForms) {
  Pull pull(beside);
  const Vec3 foot(0.1, 0.2, 0.4), across = beside - foot;
  keep_only(pull, &BoneSprings::radial);
  EXPECT_LT((pull.at(foot + 1.5 * across).spring + 3 * 0.5 * across).norm(), 1e-14);
  EXPECT_NEAR(pull.at(foot + 1.5 * across).energy, 3 * 0.25 * across.squaredNorm() / 2, 1e-15);
  EXPECT_EQ(pull.at(foot).spring, Vec3::Zero()) << "no direction on the foot itself";
  pull = Pull(beside);
  keep_only(pull, &BoneSprings::axial);
  EXPECT_LT((pull.at(beside + Vec3(0.2, 0.1, 0.3)).spring - Vec3(0, 0, -7 * 0.3)).norm(), 1e-14);
}

TEST(BoneForce, OnTheAxisTheRadialSpringIsAVectorSpringAndTwistIsNothing) {
  for (const double off : {0.0, 0.5e-6 * r}) {
    Pull pull(Vec3(0.1 + off, 0.2, 0.4));
    const Vec3 shift(0.02, 0.03, 0);
    EXPECT_LT((pull.at(pull.particle.rest + shift).spring + 3 * shift).norm(), 1e-7);
    keep_only(pull, &BoneSprings::twist);
    EXPECT_EQ(pull.at(pull.particle.rest + shift).spring, Vec3::Zero());
  }
}

TEST(BoneForce, VanishesWhenBoneAndParticleMoveTogether) {
  for (const BoneForce form : {BoneForce::paper, BoneForce::anchor})
    for (const Vec3& rest : {beside, Vec3(0.1, 0.2, 0.4), Vec3(0.3, 0.2, 1.5)}) {
      Pull pull(rest, form);
      pull.carry(test::turned({1, -2, 3}, 170), {4, 5, 6});
      EXPECT_LT(pull.here().spring.norm(), 1e-13);
      EXPECT_LT(pull.here().energy, 1e-26);
    }
}

TEST(BoneForce, DampsOnlyMotionRelativeToTheBone) {
  for (const BoneForce form : {BoneForce::paper, BoneForce::anchor}) {
    Pull pull(beside, form);
    pull.pose.velocity = {1, 2, 3};
    pull.pose.angular_velocity = {-3, 1, 2};
    const Vec3 along = pull.pose.velocity_at(beside);
    EXPECT_LT((along - Vec3(1, 2, 3) - Vec3(-3, 1, 2).cross(beside - Vec3(0.1, 0.2, 0))).norm(),
              1e-15);
    pull.particle.velocity = along;
    EXPECT_LT(pull.here().damping.norm(), 1e-15);
    pull.particle.velocity = along + Vec3(0.5, 0, 0);
    EXPECT_LT((pull.here().damping - Vec3(-0.2 * 0.5, 0, 0)).norm(), 1e-15);
    EXPECT_EQ(pull.here().force(), pull.here().spring + pull.here().damping);
  }
}

TEST(BoneForce, TheAnchorIsDampedAgainstItsTarget) {
  Pull pull(beside, BoneForce::anchor);
  pull.pose.angular_velocity = {0, 0, 2};
  pull.particle.velocity = pull.pose.velocity_at(beside);
  EXPECT_LT(pull.at(beside + Vec3(0.3, 0, 0)).damping.norm(), 1e-15);
}

TEST(BoneForce, AStretchedBoneCarriesItsParticlesAlong) {
  Pull pull(beside);
  pull.pose.stretch = 1.5;
  pull.particle.position = pull.pose.carried(beside, pull.skeleton.bones[0]);
  EXPECT_NEAR(pull.particle.position.z(), 1.5 * beside.z(), 1e-15);
  EXPECT_LT(pull.here().spring.norm(), 1e-14);
  std::mt19937 random(8);
  for (int trial = 0; trial < 20; ++trial)
    expect_gradient(pull, pull.particle.position + 0.2 * test::random_vector(random));
}

TEST(BoneForce, WhatAStretchingBonePutsInIsStored) {
  std::mt19937 random(9);
  for (const BoneForce form : {BoneForce::paper, BoneForce::anchor}) {
    Pull pull(beside, form);
    pull.springs.damping = 0;
    pull.pose.stretch = 1.4;
    pull.pose.stretch_rate = 3;
    pull.particle.position = beside + 0.3 * test::random_vector(random);
    const double power = pull.here().power, h = 1e-6;
    const auto energy = [&](double time) {
      Pull later = pull;
      later.pose.stretch += time * later.pose.stretch_rate;
      return later.here().energy;
    };
    EXPECT_NEAR(power, (energy(h) - energy(-h)) / (2 * h), 1e-7);
    EXPECT_GT(std::abs(power), 0.01);
  }
}

TEST(BoneForce, OpenLoopPushesInProportionToTheTwistAndStoresNothing) {
  Pull pull(beside);
  pull.springs = {0, 5, 0, 0, BoneForce::paper, TwistForm::open_loop};
  pull.pose.twist = radians(200);
  const Vec3 rho = beside - Vec3(0.1, 0.2, 0.4);
  EXPECT_LT((pull.here().spring - 5 * radians(200) * Vec3::UnitZ().cross(rho)).norm(), 1e-13);
  EXPECT_EQ(pull.here().energy, 0);
  pull.pose.twist = 0;
  EXPECT_EQ(pull.here().spring, Vec3::Zero());
}

TEST(BoneForce, WeightsScaleEverything) {
  Pull pull(beside);
  pull.particle.velocity = {1, 2, 3};
  const Vec3 position = beside + Vec3(0.1, -0.2, 0.3);
  const BonePull full = pull.at(position);
  pull.binding.influences[0].weight = 0.25;
  const BonePull part = pull.at(position);
  EXPECT_LT((part.spring - full.spring / 4).norm(), 1e-15);
  EXPECT_LT((part.damping - full.damping / 4).norm(), 1e-15);
  EXPECT_NEAR(part.energy, full.energy / 4, 1e-15);
}

TEST(BoneSprings, AreRelativeToTheBody) {
  Settings settings = test::box_scene();
  const Body body = test::make_body(settings, test::fcc_box(11, 11, 49, r));
  const double k = body.material.stiffness(), m = body.material.mass;
  for (std::size_t b = 0; b < 2; ++b) {
    const BoneSprings& bone = body.springs[b];
    const double unit =
        body.material.young_modulus() * volume_per_particle(r) / body.binding.cross_section[b];
    EXPECT_DOUBLE_EQ(bone.radial, 1.6 * unit);
    EXPECT_DOUBLE_EQ(bone.twist, 1.6 * unit);
    EXPECT_DOUBLE_EQ(bone.axial, 0.64 * unit);
    EXPECT_DOUBLE_EQ(bone.damping, 2 * std::sqrt(bone.radial * m));
    EXPECT_NEAR(bone.radial / k, 0.025, 0.001) << "measured in the paper's box";
    EXPECT_NEAR(bone.axial / k, 0.010, 0.0005);
  }
}

TEST(BoneSprings, TakeTheStrengthOfTheirBone) {
  Settings settings = test::box_scene(25);
  settings.bones[1].stiffness = 4;
  settings.bones[1].twist_stiffness = 3;
  settings.bones[1].axial_stiffness = 0;
  const Body body = test::make_body(settings, test::fcc_box(7, 7, 25, r));
  const auto& own = body.springs;
  const auto plain = bone_springs(settings.binding, body.material, body.binding);
  EXPECT_EQ(own[0].radial, plain[0].radial);
  EXPECT_EQ(own[0].damping, plain[0].damping);
  EXPECT_DOUBLE_EQ(own[1].radial, 4 * plain[1].radial);
  EXPECT_DOUBLE_EQ(own[1].twist, 3 * plain[1].twist);
  EXPECT_EQ(own[1].axial, 0);
  EXPECT_DOUBLE_EQ(own[1].damping, 2 * plain[1].damping);  // critical still
}

/// A pull whose springs yield at forces far below those that they would exert.
Pull yielding_pull(BoneForce form, double max_force) {
  Pull pull(beside, form);
  pull.springs.max_force = max_force;
  pull.carry(test::turned({1, 2, 3}, 50), {0.3, 0, 0.1});
  return pull;
}

TEST(BoneForce, YieldingSpringsAreMinusTheGradientOfTheirEnergyAndBounded) {
  std::mt19937 random(3);
  for (const BoneForce form : {BoneForce::paper, BoneForce::anchor}) {
    const Pull pull = yielding_pull(form, 0.3), firm = yielding_pull(form, 0);
    double most = 0;
    for (int trial = 0; trial < 200; ++trial) {
      const Vec3 position = pull.particle.position + 2 * test::random_vector(random);
      if (trial < 50) expect_gradient(pull, position);
      const BonePull now = pull.at(position), unbounded = firm.at(position);
      most = std::max(most, now.spring.norm());
      EXPECT_LE(now.spring.norm(), 0.3 * (1 + 1e-12));
      EXPECT_LE(now.energy, unbounded.energy);
      EXPECT_LT(now.spring.cross(unbounded.spring).norm(), 1e-9);  // of the same direction
      EXPECT_LT((now.radial + now.twist + now.axial - now.spring).norm(), 1e-12);
    }
    EXPECT_GT(most, form == BoneForce::anchor ? 0.299 : 0.05);
  }
}

TEST(BoneForce, NearTheAxisAndAtHalfATurnYieldingSpringsAreBoundedToo) {
  const Pull pull = yielding_pull(BoneForce::paper, 0.3);
  const Vec3 foot = pull.pose.frame.origin + pull.pose.frame.rotation * Vec3(0.4, 0, 0);
  for (const double distance : {1e-6, 1e-3, 0.05, 0.13, 0.14, 0.27})
    for (int angle = 0; angle < 360; angle += 10) {
      const Vec3 across = test::turned(Vec3::UnitX(), angle) * Vec3(0, distance, 0);
      EXPECT_LE(pull.at(foot + pull.pose.frame.rotation * across).spring.norm(), 0.3 * (1 + 1e-12));
    }
}

TEST(BoneForce, SpringsDoNotYieldBelowTheirEnergy) {
  const Pull pull = yielding_pull(BoneForce::paper, 100), firm = yielding_pull(BoneForce::paper, 0);
  const Vec3 position = pull.particle.position + Vec3(0.01, 0.02, -0.01);
  EXPECT_EQ(pull.at(position).spring, firm.at(position).spring);
  EXPECT_EQ(pull.at(position).energy, firm.at(position).energy);
}

}  // namespace sinew::bone_force_test

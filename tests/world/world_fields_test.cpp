// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <sinew/scene/rig.h>
#include <sinew/world/force_field.h>
#include <sinew/world/pins.h>
#include <sinew/world/world.h>

#include "support/expect_error.h"
#include "support/world.h"
#include "support/world_forces.h"

namespace sinew::world_fields_test {

using namespace test;

constexpr ParticleInfo grain = {0.005, 6e-6};

TEST(KeyedValues, AreStraightBetweenKeysAndConstantOutside) {
  const KeyedValue keys = {{1, 2, 4}, {0, 3, -1}};
  EXPECT_EQ(keys.at(0), 0);
  EXPECT_EQ(keys.at(1), 0);
  EXPECT_NEAR(keys.at(1.5), 1.5, 1e-15);
  EXPECT_EQ(keys.at(2), 3);
  EXPECT_NEAR(keys.at(3), 1, 1e-15);
  EXPECT_EQ(keys.at(9), -1);
  EXPECT_EQ(keys.largest(), 3);
  EXPECT_EQ(KeyedValue{}.at(7), 1);
  EXPECT_EQ(KeyedValue{}.largest(), 1);
  EXPECT_EQ((KeyedValue{{3}, {0.5}}).at(0), 0.5);
}

TEST(KeyedValues, RatesAreTheSlopesOfTheLines) {
  const KeyedValue keys = {{1, 2, 4}, {0, 3, -1}};
  EXPECT_EQ(keys.rate(0.5), 0);
  EXPECT_EQ(keys.rate(1), 3);
  EXPECT_EQ(keys.rate(1.5), 3);
  EXPECT_EQ(keys.rate(2), -2);
  EXPECT_EQ(keys.rate(4), 0);
  EXPECT_EQ(KeyedValue{}.rate(1), 0);
}

TEST(KeyedValues, OutsideTheirBoundsAreRefused) {
  check_keys({{0, 1, 2}, {-1, 0.5, 2}}, -1, 2, "the wind");
  check_keys({{}, {}}, -1, 2, "the wind");
  const auto refused = [](const KeyedValue& keys, const std::string& why) {
    test::expect_bad_input([&] { check_keys(keys, -1, 2, "the wind"); }, {"the wind", why});
  };
  for (const double value : {-1.1, 2.1, static_cast<double>(NAN), HUGE_VAL, -HUGE_VAL}) {
    refused({{0}, {value}}, "has the value");
    refused({{0, 1}, {0, value}}, "has the value");
  }
  for (const double time : {-1.0, 0.0, static_cast<double>(NAN), HUGE_VAL})
    refused({{0, time}, {0, 0}}, "does not come later");
  refused({{NAN}, {0}}, "does not come later");
  refused({{0, 1}, {0}}, "2 times and 1 values");
}

TEST(ForceFields, HaveTheirClosedForms) {
  const Vec3 p(0.3, 0.4, 0);
  const auto force = [&](const FieldForm& form, double scale = 1) -> Vec3 {
    return field_force({"f", form, {}, {}}, scale, p, grain);
  };
  EXPECT_EQ(force(UniformAcceleration{{0, 0, -2}}), grain.mass * Vec3(0, 0, -2));
  EXPECT_EQ(force(ForceDensity{{7, 0, 0}}, 2), 2 * grain.volume * Vec3(7, 0, 0));
  EXPECT_NEAR((force(Attraction{{0, 0, 0}, 5, 0.1}) - grain.mass * Vec3(-3, -4, 0)).norm(), 0,
              1e-17);
  EXPECT_NEAR((force(Attraction{{0, 0, 0}, 5, 1}) - grain.mass * Vec3(-1.5, -2, 0)).norm(), 0,
              1e-17);
  EXPECT_NEAR((force(Swirl{{0, 0, 9}, {0, 0, 3}, 5, 0.1}) - grain.mass * Vec3(-4, 3, 0)).norm(), 0,
              1e-16);
  EXPECT_EQ(force(Attraction{p, 5, 0.1}), Vec3(0, 0, 0));
}

TEST(ForceFields, AxesAndCoresMayBeOfAnyLength) {
  for (const double length : {1e-6, 1.0, 1e6}) {
    check_field({"whirl", Swirl{{0, 0, 0}, {0, 0, length}, 1, length}, {}, {}});
    check_field({"pull", Attraction{{0, 0, 0}, 1, length}, {}, {}});
  }
}

TEST(ForceFields, EndWithTheirRegion) {
  const ForceField field = {
      "f", UniformAcceleration{{1, 0, 0}}, {SphereShape{{0, 0, 0}, 1}, 1}, {}};
  EXPECT_EQ(field_force(field, 1, {0.5, 0, 0}, grain).x(), grain.mass);
  EXPECT_NEAR(field_force(field, 1, {1.5, 0, 0}, grain).x(), grain.mass / 2, 1e-18);
  EXPECT_EQ(field_force(field, 1, {2, 0, 0}, grain).x(), 0);
}

TEST(ForceFields, ChangeFromPlaceToPlaceNoFasterThanTheBound) {
  std::mt19937 random(5);
  const Region edge = {BoxShape{{0, 0, 0}, {0.2, 0.3, 0.1}}, 0.15};
  const KeyedValue keys = {{0, 1}, {0, -2}};
  for (const FieldForm& form :
       {FieldForm(UniformAcceleration{{1, 2, 3}}), FieldForm(ForceDensity{{300, 0, 0}}),
        FieldForm(Attraction{{0.1, 0, 0}, 5, 0.05}),
        FieldForm(Swirl{{0, 0.1, 0}, {1, 1, 0}, 5, 0.1})})
    for (const ForceField& field : {ForceField{"f", form, edge, keys}, {"f", form, {}, keys}}) {
      double steepest = 0;
      for (int trial = 0; trial < 3000; ++trial) {
        const Vec3 p = test::random_vector(random), step = 1e-4 * test::random_vector(random);
        const Vec3 change =
            field_force(field, -2, p + step, grain) - field_force(field, -2, p, grain);
        steepest = std::max(steepest, change.norm() / step.norm());
      }
      const double bound = field_stiffness(field, grain);
      EXPECT_LE(steepest, bound + 1e-12);
      EXPECT_GE(steepest, 0.3 * bound);
    }
}

TEST(ForceFields, BadOnesAreRefusedByName) {
  const auto refused = [](const ForceField& field, const std::string& why) {
    test::expect_bad_input([&] { check_field(field); }, {"'wind'", why});
  };
  refused({"wind", Attraction{{0, 0, 0}, 1, 0}, {}, {}}, "a core of 0");
  refused({"wind", Swirl{{0, 0, 0}, {0, 0, 0}, 1, 1}, {}, {}}, "an axis without length");
  refused({"wind", UniformAcceleration{{NAN, 0, 0}}, {}, {}}, "not finite");
  refused({"wind", UniformAcceleration{}, {SphereShape{{0, 0, 0}, -1}, 0}, {}}, "a radius of -1");
  refused({"wind", UniformAcceleration{}, {}, {{0, 0}, {1, 1}}}, "does not come later");
  test::expect_bad_input([] { check_drag({-1, {0, 0, 0}}); }, {"drag has a rate of -1"});
}

TEST(Drag, SlowsExponentiallyToTheVelocityOfTheMedium) {
  World world;
  world.drag = {3, {0.5, 0, -1}};
  Particles one = particles_at({Vec3::Zero()}, 0.01, 0.005);
  one.set_velocity(0, {2, 1, 0});
  const Vec3 start = one.velocity(0) - world.drag.velocity;
  WorldForces forces;
  const double dt = 1e-5;
  for (int step = 0; step < 50000; ++step) {
    world_forces(one, world, {}, forces);
    one.set_velocity(0, one.velocity(0) + dt / one.mass * forces.total(0));
  }
  const Vec3 expected = world.drag.velocity + std::exp(-3 * 50000 * dt) * start;
  EXPECT_NEAR((one.velocity(0) - expected).norm(), 0, 2e-5);
}

TEST(Drag, LosesRateTimesMassTimesTheSquareOfTheRelativeVelocity) {
  World world;
  world.drag = {3, {0.5, 0, -1}};
  Particles one = particles_at({Vec3::Zero()}, 0.01, 0.005);
  one.set_velocity(0, {2, 1, 0});
  WorldForces forces;
  world_forces(one, world, {}, forces);
  const WorldPowers powers = world_powers(forces, {one.velocity(0)});
  const Vec3 relative = one.velocity(0) - world.drag.velocity;
  EXPECT_NEAR(powers.lost, 3 * 0.005 * relative.squaredNorm(), 1e-15);
  EXPECT_NEAR(powers.obstacles - powers.lost, forces.drag[0].dot(one.velocity(0)), 1e-15);
}

const Points row = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};

TEST(Pins, HoldTheParticlesInTheirShapeAndOnIt) {
  const Pin box = {{BoxShape{{0, 0, 0}, {1, 1, 1}}, 0.9}, no_bone};
  const Pin ball = {{SphereShape{{2, 0, 0}, 1}, 0}, 1};
  const auto held = pinned(row, {box, ball}, 2);
  ASSERT_EQ(held.size(), 4U);
  const int bones[] = {no_bone, no_bone, 1, 1};  // both have particle 1: the first holds it
  for (std::uint32_t i = 0; i < 4; ++i) {
    EXPECT_EQ(held[i].particle, i);
    EXPECT_EQ(held[i].bone, bones[i]);
  }
  EXPECT_EQ(pinned(row, {ball}, 2).size(), 3U);
  EXPECT_TRUE(pinned(row, {}, 2).empty());
}

TEST(Pins, StayOrGoWithTheirBone) {
  Settings scene = test::box_scene();
  scene.tracks = {test::track("upper", {test::bend_key(0, 0), test::bend_key(1, 90)})};
  const Skeleton skeleton = skeleton_of(scene);
  const Motion motion = motion_of(scene, skeleton);
  const Vec3 rest(0.1, 0.2, 0.5);
  const auto at = [&](double time, int bone) {
    return pin_pose({0, bone}, rest, skeleton, pose_at(skeleton, motion, time));
  };
  EXPECT_EQ(at(0.5, no_bone).position, rest);
  EXPECT_EQ(at(0.5, no_bone).velocity, Vec3(0, 0, 0));
  EXPECT_NEAR((at(0, 1).position - rest).norm(), 0, 1e-15);
  const Vec3 head = skeleton.bones[1].head();
  const Vec3 turned = head + test::turned(Vec3::UnitY(), 90) * (rest - head);
  EXPECT_NEAR((at(1, 1).position - turned).norm(), 0, 1e-14);
  const double h = 1e-6;
  const Vec3 velocity = (at(0.4 + h, 1).position - at(0.4 - h, 1).position) / (2 * h);
  EXPECT_NEAR((at(0.4, 1).velocity - velocity).norm(), 0, 1e-8);
}

TEST(Pins, BadOnesAreRefused) {
  const Pin far = {{SphereShape{{9, 9, 9}, 1}, 0}, no_bone}, lost = {{}, 2};
  test::expect_bad_input([&] { pinned(row, {{{}, 0}, far}, 2); }, {"pin 1 holds 0 particles"});
  test::expect_bad_input([&] { pinned(row, {lost}, 2); }, {"pin 0", "bone 2 of 2"});
}

}  // namespace sinew::world_fields_test

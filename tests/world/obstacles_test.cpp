// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <sinew/body/forces.h>
#include <sinew/scene/rig.h>
#include <sinew/world/obstacle.h>
#include <sinew/world/world.h>

#include "support/expect_error.h"
#include "support/world.h"
#include "support/world_forces.h"

namespace sinew::obstacles_test {

using namespace test;

constexpr double r = 0.01, mass = 0.005, g = 9.81;

Obstacle floor_of(const Vec3& normal) {
  Obstacle obstacle;
  obstacle.name = "floor";
  obstacle.shape = PlaneShape{Vec3::Zero(), normal};
  obstacle.stiffness = 200;
  obstacle.damping = std::sqrt(200 * mass);
  return obstacle;
}

/// One particle under gravity and the world, from `position`, for `steps` of `dt` (s).
Particles fallen(const World& world, const Vec3& position, const Vec3& velocity, int steps,
                 double dt) {
  Particles one = particles_at({position}, r, mass);
  one.set_velocity(0, velocity);
  const WorldNow now = world_at(world, 0, {});
  WorldForces forces;
  for (int step = 0; step < steps; ++step) {
    world_forces(one, world, now, forces);
    one.set_velocity(0, one.velocity(0) + dt * (forces.total(0) / mass - g * Vec3::UnitZ()));
    one.set_position(0, one.position(0) + dt * one.velocity(0));
  }
  return one;
}

TEST(Obstacles, ABallRestsOnAPlaneByItsWeightOverTheStiffness) {
  World world;
  world.obstacles = {floor_of(Vec3::UnitZ())};
  const Particles one = fallen(world, {0, 0, 1.5 * r}, Vec3::Zero(), 5000, 5e-4);
  EXPECT_NEAR(r - one.z[0], mass * g / 200, 1e-12);
  EXPECT_NEAR(one.w[0], 0, 1e-12);
}

TEST(Obstacles, GiveNothingButWhatTheyAreGiven) {
  Obstacle bare;
  bare.shape = PlaneShape{Vec3::Zero(), Vec3::UnitZ()};
  Particles one = particles_at({{0, 0, 0.6 * r}}, r, mass);
  one.set_velocity(0, {0.3, 0.2, -0.5});
  World world;
  WorldForces forces;
  world.obstacles = {bare};
  world_forces(one, world, world_at(world, 0, {}), forces);
  EXPECT_EQ(forces.total(0), Vec3(0, 0, 0));
  world.obstacles[0].stiffness = 200;
  world_forces(one, world, world_at(world, 0, {}), forces);
  EXPECT_LT((forces.total(0) - Vec3(0, 0, 200 * 0.4 * r)).norm(), 1e-14);
}

/// The same, with friction that stops sliding in the step.
Particles stopped(const World& world, const Vec3& position, const Vec3& velocity, int steps,
                  double dt) {
  Particles one = particles_at({position}, r, mass);
  one.set_velocity(0, velocity);
  const WorldNow now = world_at(world, 0, {});
  const Vec3 weight = -mass * g * Vec3::UnitZ();
  WorldForces forces;
  for (int step = 0; step < steps; ++step) {
    world_forces(one, world, now, forces);
    stop_sliding(one, world, now, {forces.total(0) + weight}, dt, forces);
    one.set_velocity(0, one.velocity(0) + dt / mass * (forces.total(0) + weight));
    one.set_position(0, one.position(0) + dt * one.velocity(0));
  }
  return one;
}

/// Slope of an incline of `angle` degrees: downhill direction, and the floor.
struct Incline {
  Vec3 normal, downhill;
  World world;

  Incline(double angle, double friction, double stick) {
    normal = test::turned(Vec3::UnitY(), angle) * Vec3::UnitZ();
    downhill = test::turned(Vec3::UnitY(), angle) * Vec3::UnitX();
    Obstacle floor = floor_of(normal);
    floor.friction = friction;
    floor.stick = stick;
    world.obstacles = {floor};
  }
  Vec3 resting(double angle) const {
    return (r - mass * g * std::cos(radians(angle)) / 200) * normal;
  }
};

TEST(Obstacles, ABlockSlidesDownAtGTimesSinMinusMuCos) {
  const double angle = 35, mu = 0.4, dt = 2e-4;
  const Incline incline(angle, mu, mass / (2 * dt));
  const double expected = g * (std::sin(radians(angle)) - mu * std::cos(radians(angle)));
  const Vec3 v0 = 0.1 * incline.downhill;
  const Particles one = fallen(incline.world, incline.resting(angle), v0, 1000, dt);
  EXPECT_NEAR((one.velocity(0) - v0).dot(incline.downhill) / (1000 * dt), expected, 1e-9);
}

TEST(Obstacles, ABlockSticksBelowTheAngleOfFrictionButForTheCreepStated) {
  const double angle = 20, mu = 0.4, dt = 2e-4, stick = mass / (2 * dt);
  ASSERT_GT(mu, std::tan(radians(angle)));
  const Incline incline(angle, mu, stick);
  const Particles one =
      fallen(incline.world, incline.resting(angle), 0.05 * incline.downhill, 5000, dt);
  const double creep = mass * g * std::sin(radians(angle)) / stick;
  EXPECT_NEAR(one.velocity(0).dot(incline.downhill), creep, 1e-12);
  EXPECT_LT(creep, 2e-3);
}

TEST(Obstacles, WithStopSlidingABlockSlidesAsCoulombSays) {
  const double angle = 35, mu = 0.4, dt = 2e-4;
  const Incline incline(angle, mu, 0);
  const double expected = g * (std::sin(radians(angle)) - mu * std::cos(radians(angle)));
  const Particles one = stopped(incline.world, incline.resting(angle), Vec3::Zero(), 1000, dt);
  EXPECT_NEAR(one.velocity(0).dot(incline.downhill) / (1000 * dt), expected, 1e-9);
}

TEST(Obstacles, WithStopSlidingABlockHoldsFastBelowTheAngleOfFriction) {
  const double angle = 20, mu = 0.4, dt = 2e-4, speed = 0.05;
  const Incline incline(angle, mu, 0);
  const Vec3 start = incline.resting(angle);
  const Particles one = stopped(incline.world, start, speed * incline.downhill, 5000, dt);
  EXPECT_LT(one.velocity(0).norm(), 1e-12);
  const double brake = g * (mu * std::cos(radians(angle)) - std::sin(radians(angle)));
  const double distance = speed * speed / (2 * brake);
  EXPECT_NEAR((one.position(0) - start).dot(incline.downhill), distance, speed * dt);
  const Particles later = stopped(incline.world, one.position(0), Vec3::Zero(), 5000, dt);
  EXPECT_NEAR((later.position(0) - one.position(0)).norm(), 0, 1e-12);
}

TEST(Obstacles, StoppingFrictionIsTangentAndNoMoreThanItMustAndCanBe) {
  Obstacle floor = floor_of(Vec3::UnitZ());
  floor.friction = 0.5;
  const Contact touch = contact(floor, {}, {0, 0, 0.9 * r}, Vec3::Zero(), r);
  const double most = 0.5 * 200 * 0.1 * r, dt = 1e-3, slow = 0.5 * most * dt / mass;
  const auto friction = [&](const Vec3& relative) {
    return stopping_friction(floor, 1, touch, relative, mass, dt);
  };
  EXPECT_NEAR((friction({0, slow, 7}) - mass / dt * Vec3(0, -slow, 0)).norm(), 0, 1e-15);
  EXPECT_NEAR((friction({9 * slow, 0, 7}) - Vec3(-most, 0, 0)).norm(), 0, 1e-15);
  EXPECT_EQ(friction({0, 0, 7}), Vec3(0, 0, 0));
}

/// Both kinds of friction are mu times the factor of the moment.
TEST(Obstacles, FrictionFollowsItsKeys) {
  const double dt = 1e-3, fast = 1e3;
  for (const double stick : {0.0, 2.0}) {
    Obstacle floor = floor_of(Vec3::UnitZ());
    floor.friction = 0.5, floor.stick = stick;
    floor.friction_scale = {{1, 3}, {1, 0.2}};
    for (const auto& [time, factor] : {std::pair{0.0, 1.0}, {2.0, 0.6}, {4.0, 0.2}}) {
      const ObstaclePose now = floor.at(time, {});
      const Contact touch = contact(floor, now, {0, 0, 0.9 * r}, {fast, 0, 0}, r);
      const Vec3 stopping = stopping_friction(floor, now.friction, touch, {fast, 0, 0}, mass, dt);
      const Vec3 felt = stick > 0 ? touch.friction : stopping;
      EXPECT_NEAR(felt.x(), -0.5 * factor * touch.pressing, 1e-12) << time;
    }
  }
}

TEST(Obstacles, StopSlidingLeavesThoseWithStickAlone) {
  const Incline incline(20, 0.4, 2);
  Particles one = particles_at({incline.resting(20)}, r, mass);
  one.set_velocity(0, incline.downhill);
  const WorldNow now = world_at(incline.world, 0, {});
  WorldForces forces;
  world_forces(one, incline.world, now, forces);
  const Vec3 before = forces.total(0);
  stop_sliding(one, incline.world, now, {before}, 1e-3, forces);
  EXPECT_EQ(forces.total(0), before);
}

TEST(Obstacles, WithStopSlidingABeltCarriesABlock) {
  World world;
  world.obstacles = {floor_of(Vec3::UnitZ())};
  world.obstacles[0].friction = 0.3;
  world.obstacles[0].motion = [](double, const Pose&) {
    ObstaclePose pose;
    pose.velocity = {0.2, 0.1, 0};
    return pose;
  };
  const Vec3 resting(0, 0, r - mass * g / 200);
  const double dt = 2e-4;
  const Particles early = stopped(world, resting, Vec3::Zero(), 100, dt);
  EXPECT_NEAR(early.velocity(0).norm(), 0.3 * g * 100 * dt, 1e-9);
  const Particles late = stopped(world, resting, Vec3::Zero(), 1000, dt);
  EXPECT_NEAR((late.velocity(0) - Vec3(0.2, 0.1, 0)).norm(), 0, 1e-12);
}

/// A block of the scene's material on an incline of `angle` degrees with friction 0.5: its mean
/// velocity downhill after `steps` steps.
double block_on_incline(double angle, double stick, int steps) {
  const Material material = test::material_of(test::box_scene());
  const double dt = 0.3 * std::sqrt(material.mass / material.stiffness());
  World world;
  world.obstacles = {floor_of(Vec3::UnitZ())};
  world.obstacles[0].stiffness = material.stiffness();
  world.obstacles[0].friction = 0.5;
  world.obstacles[0].stick = stick * material.mass / dt;
  world.drag.rate = 4;
  world.fields = {{"weight",
                   UniformAcceleration{test::turned(Vec3::UnitY(), -angle) * Vec3(0, 0, -g)},
                   {},
                   {{0, 0.2}, {0, 1}}}};
  Points rest = test::fcc_box(7, 7, 7, r);
  for (Vec3& point : rest) point.z() += r - half_plane_spacing(r) / 2;
  Particles block = particles_at(rest, r, material.mass);
  Forces forces;
  WorldForces outer;
  Points all(block.size());
  for (int step = 0; step < steps; ++step) {
    const WorldNow now = world_at(world, step * dt, {});
    pair_forces(block, material, forces);
    world_forces(block, world, now, outer);
    for (std::size_t i = 0; i < all.size(); ++i)
      all[i] = forces.pair[i] + forces.damping[i] + outer.total(i);
    stop_sliding(block, world, now, all, dt, outer);
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Vec3 force = forces.pair[i] + forces.damping[i] + outer.total(i);
      block.set_velocity(i, block.velocity(i) + dt / block.mass * force);
      block.set_position(i, block.position(i) + dt * block.velocity(i));
    }
  }
  double sum = 0;
  for (std::size_t i = 0; i < block.size(); ++i) sum += block.u[i];
  return sum / static_cast<double>(block.size());
}

TEST(Obstacles, ABodyHoldsFastBelowTheAngleOfFriction) {
  const double creep = block_on_incline(20, 0.5, 3000), sticking = block_on_incline(20, 0, 3000);
  EXPECT_LT(std::abs(sticking), 1e-6);
  EXPECT_LT(std::abs(creep), 0.1);
  EXPECT_GT(std::abs(block_on_incline(35, 0, 3000)), 0.1);
}

TEST(Obstacles, TheSpringIsMinusTheGradientOfItsEnergy) {
  std::mt19937 random(1);
  Obstacle obstacle = floor_of(Vec3::UnitZ());
  ObstaclePose pose;
  pose.frame = {{0.1, 0, 0.2}, test::turned({1, 1, 2}, 70)};
  const double h = 1e-8;
  for (const Shape& shape :
       {Shape(SphereShape{{0, 0, 0}, 0.3}), Shape(CapsuleShape{{0, 0, 0}, {0.3, 0, 0}, 0.2}),
        Shape(BoxShape{{0, 0, 0}, {0.2, 0.3, 0.4}}), Shape(PlaneShape{})}) {
    obstacle.shape = shape;
    const auto at = [&](const Vec3& p) { return contact(obstacle, pose, p, Vec3::Zero(), r); };
    for (int trial = 0; trial < 100; ++trial) {
      const Vec3 p = pose.frame.origin + test::random_vector(random);
      for (int axis = 0; axis < 3; ++axis) {
        const Vec3 step = h * Vec3::Unit(axis);
        const double slope = (at(p + step).energy - at(p - step).energy) / (2 * h);
        EXPECT_NEAR(at(p).spring[axis], -slope, 1e-4) << p.transpose();
      }
    }
  }
}

TEST(Obstacles, DampingBrakesTheApproachAloneAndNothingPulls) {
  Obstacle floor = floor_of(Vec3::UnitZ());
  const Vec3 touching(0, 0, 0.9 * r);
  const Contact coming = contact(floor, {}, touching, {0, 0, -2}, r);
  EXPECT_NEAR(coming.damping.z(), 2 * floor.damping, 1e-15);
  const Contact going = contact(floor, {}, touching, {0, 0, 1000}, r);
  EXPECT_EQ(going.damping, Vec3(0, 0, 0));
  EXPECT_NEAR(going.force().z(), 200 * 0.1 * r, 1e-15);
  EXPECT_EQ(contact(floor, {}, {0, 0, r}, {0, 0, -2}, r).force(), Vec3(0, 0, 0));
}

TEST(Obstacles, FrictionOpposesSlidingAndIsMuTimesTheNormalForce) {
  Obstacle floor = floor_of(Vec3::UnitZ());
  floor.friction = 0.5;
  floor.stick = 1;
  const Vec3 touching(0, 0, 0.9 * r);
  const double normal = 200 * 0.1 * r, slip = 0.5 * normal / floor.stick;
  for (const double speed : {0.0, 0.1 * slip, slip, 5 * slip, 1e6}) {
    const Contact touch = contact(floor, {}, touching, {0, speed, 0}, r);
    EXPECT_NEAR(touch.friction.y(), -std::min(0.5 * normal, floor.stick * speed), 1e-12);
    EXPECT_EQ(touch.friction.x(), 0);
    EXPECT_EQ(touch.friction.z(), 0);
  }
}

TEST(Obstacles, FrictionOfAnApproachIsTangentAndCountsItsDamping) {
  Obstacle floor = floor_of(Vec3::UnitZ());
  floor.friction = 0.5;
  floor.stick = 100;
  const Vec3 touching(0, 0, 0.9 * r);
  const Contact touch = contact(floor, {}, touching, {0.3, 0.4, -2}, r);
  const double normal = 200 * 0.1 * r + 2 * floor.damping;
  EXPECT_NEAR((touch.friction + 0.5 * normal * Vec3(0.6, 0.8, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR(touch.force().z(), normal, 1e-12);
  const Contact leaving = contact(floor, {}, touching, {0.3, 0.4, 2}, r);
  EXPECT_NEAR((leaving.friction + 0.1 * r * 100 * Vec3(0.6, 0.8, 0)).norm(), 0, 1e-12);
}

TEST(Obstacles, OnlyMotionRelativeToTheObstacleIsBraked) {
  Obstacle ball = floor_of(Vec3::UnitZ());
  ball.shape = SphereShape{{0, 0, 0}, 0.3};
  ball.friction = 0.5;
  ball.stick = 2;
  ObstaclePose pose;
  pose.velocity = {1, -2, 3};
  pose.angular_velocity = {4, 0, -5};
  pose.frame.origin = {0.1, 0.2, 0.3};
  const Vec3 touching = pose.frame.origin + (0.3 + 0.5 * r) * Vec3(1, 2, 2) / 3;
  const Vec3 riding_along = pose.velocity_at(touching), slip(0.1, -0.2, -0.1);
  EXPECT_NEAR(contact(ball, pose, touching, riding_along, r).losing().norm(), 0, 1e-15);
  ObstaclePose resting;
  resting.frame = pose.frame;
  const Contact moved = contact(ball, pose, touching, riding_along + slip, r);
  const Contact still_one = contact(ball, resting, touching, slip, r);
  EXPECT_GT(still_one.losing().norm(), 0.01);
  EXPECT_NEAR((moved.losing() - still_one.losing()).norm(), 0, 1e-14);
}

TEST(Obstacles, AParticleDeepInsideIsPushedOutByTheNearestFace) {
  Obstacle box = floor_of(Vec3::UnitZ());
  box.shape = BoxShape{{0, 0, 0}, {1, 2, 3}};
  const Contact deep = contact(box, {}, {-0.4, 0.5, 0.5}, Vec3::Zero(), r);
  EXPECT_NEAR(deep.force().x(), -200 * (0.6 + r), 1e-12);
  EXPECT_NEAR(deep.energy, 100 * (0.6 + r) * (0.6 + r), 1e-12);
  EXPECT_GT(contact(box, {}, {0, 0, 0}, Vec3::Zero(), r).force().norm(), 200);
}

TEST(Obstacles, AStillOneStaysAndOneWithoutMotionIsInTheScene) {
  const RigidFrame frame = {{1, 2, 3}, test::turned({1, 0, 0}, 30)};
  EXPECT_EQ(still(frame)(5, {}).frame.origin, frame.origin);
  EXPECT_EQ(still(frame)(5, {}).frame.rotation, frame.rotation);
  EXPECT_EQ(Obstacle{}.at(5, {}).frame.rotation, Mat3(Mat3::Identity()));
}

TEST(Obstacles, AnAttachedOneMovesWithItsBone) {
  Settings scene = test::box_scene();
  scene.tracks = {test::track("upper", {test::bend_key(0, 0), test::bend_key(1, 90)})};
  const Skeleton skeleton = skeleton_of(scene);
  const Motion motion = motion_of(scene, skeleton);
  const RigidFrame frame = {{0.1, 0.05, 0.6}, test::turned({1, 2, 0}, 20)};
  const ObstacleMotion drift = attached_to_bone(1, skeleton.bones[1], frame);
  const auto at = [&](double time) { return drift(time, pose_at(skeleton, motion, time)); };
  EXPECT_NEAR((at(0).frame.origin - frame.origin).norm(), 0, 1e-15);
  const Vec3 head = skeleton.bones[1].head();
  const Vec3 turned = head + test::turned(Vec3::UnitY(), 90) * (frame.origin - head);
  EXPECT_NEAR((at(1).frame.origin - turned).norm(), 0, 1e-14);
  const double h = 1e-6;
  const Vec3 on_it(0.02, 0.03, 0.04);
  const auto place = [&](double time) -> Vec3 {
    return at(time).frame.origin + at(time).frame.rotation * on_it;
  };
  const Vec3 velocity = (place(0.4 + h) - place(0.4 - h)) / (2 * h);
  EXPECT_NEAR((at(0.4).velocity_at(place(0.4)) - velocity).norm(), 0, 1e-8);
}

TEST(Obstacles, BadOnesAreRefusedByName) {
  Obstacle floor = floor_of(Vec3::UnitZ());
  floor.friction = -0.1;
  test::expect_bad_input([&] { check_obstacle(floor); },
                         {"obstacle 'floor' has a friction of -0.1"});
  floor = floor_of(Vec3::UnitZ());
  floor.stiffness = INFINITY;
  test::expect_bad_input([&] { check_obstacle(floor); }, {"stiffness of inf"});
  EXPECT_NO_THROW(check_obstacle(floor_of(Vec3::UnitZ())));
}

}  // namespace sinew::obstacles_test

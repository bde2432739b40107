// SPDX-License-Identifier: GPL-3.0-or-later
// The reactions on moving obstacles, and the balance of their work.
#include <gtest/gtest.h>
#include <cmath>

#include <sinew/body/forces.h>
#include <sinew/world/obstacle.h>
#include <sinew/world/world.h>

#include "support/world.h"
#include "support/world_forces.h"

namespace sinew::obstacle_work_test {

using namespace test;

constexpr double r = 0.01, mass = 0.005;

/// A shaken ball of particles between two moving obstacles with friction.
struct Squeezed {
  World world;
  Particles particles;
  WorldNow now;
  WorldForces forces;

  Squeezed() {
    Obstacle ball;
    ball.stiffness = 200;
    ball.damping = std::sqrt(200 * mass);
    ball.shape = SphereShape{{0, 0, 0}, 3 * r};
    ball.friction = 0.3;
    ball.stick = 2;
    Obstacle box = ball;
    box.shape = BoxShape{{0, 0, 0}, {4 * r, 4 * r, r}};
    world.obstacles = {ball, box};
    now = world_at(world, 0, {});
    now.obstacles[0] = {{{5 * r, 0, 0}, test::turned({1, 0, 1}, 20)}, {-1, 0.2, 0}, {3, 1, 2}};
    now.obstacles[1] = {{{0, 0, -5 * r}, test::turned({0, 1, 1}, 10)}, {0, 0, 0.5}, {-1, 4, 0}};
    Material material;
    material.pair.r = r;
    material.mass = mass;
    particles = test::shaken(test::fcc_ball(6, r), material, 0.2 * r, 0.5);
    world_forces(particles, world, now, forces);
  }
};

TEST(Obstacles, ReactionsAreTheOppositeOfTheForcesAndOfTheirPower) {
  const Squeezed squeezed;
  Vec3 sum = Vec3::Zero();
  double power = 0;
  for (std::size_t i = 0; i < squeezed.particles.size(); ++i) sum += squeezed.forces.contact[i];
  for (std::size_t k = 0; k < 2; ++k) {
    const Reaction& reaction = squeezed.forces.reactions[k];
    EXPECT_GT(reaction.force.norm(), 0.1);
    sum += reaction.force;
    power -= reaction.force.dot(squeezed.now.obstacles[k].velocity) +
             reaction.moment.dot(squeezed.now.obstacles[k].angular_velocity);
  }
  EXPECT_NEAR(sum.norm(), 0, 1e-12);
  Points velocities(squeezed.particles.size());
  for (std::size_t i = 0; i < velocities.size(); ++i)
    velocities[i] = squeezed.particles.velocity(i);
  const WorldPowers powers = world_powers(squeezed.forces, velocities);
  EXPECT_NEAR(powers.obstacles, power, 1e-12 * std::abs(power));
  EXPECT_GT(powers.lost, 0);
}

/// The energy stored dt later, if particles and obstacles kept their velocities.
double drifted_energy(Squeezed scene, double dt) {
  for (std::size_t i = 0; i < scene.particles.size(); ++i)
    scene.particles.set_position(i, scene.particles.position(i) + dt * scene.particles.velocity(i));
  for (ObstaclePose& pose : scene.now.obstacles) {
    const Vec3 turn = dt * pose.angular_velocity;
    pose.frame.origin += dt * pose.velocity;
    pose.frame.rotation =
        Eigen::AngleAxisd(turn.norm(), turn.stableNormalized()) * pose.frame.rotation;
  }
  world_forces(scene.particles, scene.world, scene.now, scene.forces);
  return scene.forces.contact_energy;
}

TEST(Obstacles, WhatTheyPutInIsStoredLostOrGivenToTheParticles) {
  const Squeezed scene;
  Points velocities(scene.particles.size());
  double given = 0;
  for (std::size_t i = 0; i < velocities.size(); ++i) {
    velocities[i] = scene.particles.velocity(i);
    given += scene.forces.contact[i].dot(velocities[i]);
  }
  const double h = 1e-7;
  const double stored = (drifted_energy(scene, h) - drifted_energy(scene, -h)) / (2 * h);
  const WorldPowers powers = world_powers(scene.forces, velocities);
  EXPECT_NEAR(powers.obstacles, stored + powers.lost + given, 1e-5 * std::abs(powers.obstacles));
}

}  // namespace sinew::obstacle_work_test

// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/world/world.h>

#include <gtest/gtest.h>

#include <sinew/core/parallel.h>

#include "support/expect_error.h"
#include "support/world.h"
#include "support/world_forces.h"

namespace sinew::world_test {

using namespace test;

constexpr double r = 0.01;

Obstacle rubbing(const Shape& shape) {
  Obstacle obstacle;
  obstacle.name = "wall";
  obstacle.shape = shape;
  obstacle.stiffness = 150;
  obstacle.damping = 0.4;
  obstacle.friction = 0.5;
  obstacle.stick = 0.6;
  return obstacle;
}

/// All kinds of objects around a body at `rest`.
World busy_world(const Points& rest) {
  World world;
  world.obstacles = {rubbing(PlaneShape{{0, 0, -4 * r}, {0, 0, 1}}),
                     rubbing(SphereShape{{5 * r, 0, 0}, 3 * r})};
  world.obstacles[1].stick = 0;  // left to stop_sliding
  world.obstacles[1].motion = [](double time, const Pose&) {
    ObstaclePose pose;
    pose.velocity = {-0.3, 0.1, 0};
    pose.angular_velocity = {0, 2, 5};
    pose.frame.origin = time * pose.velocity;
    const Vec3& spin = pose.angular_velocity;
    pose.frame.rotation = Eigen::AngleAxisd(time * spin.norm(), spin.normalized()).matrix();
    return pose;
  };
  world.drag = {0.7, {0.1, 0.2, 0}};
  world.fields = {{"pull", UniformAcceleration{{0, 0, -9.81}}, {}, {}},
                  {"whirl",
                   Swirl{{0, 0, 0}, {0, 0, 1}, 4, 2 * r},
                   {SphereShape{{0, 0, 0}, 3 * r}, 3 * r},
                   {{0, 1}, {0, 1}}}};
  Muscle muscle;
  muscle.strength = 2000;
  muscle.direction = {1, 1, 0};
  muscle.activation = {{0, 0.1}, {0, 1}};
  muscle.weights = weights_in({SphereShape{{0, 0, 0}, 3 * r}, 2 * r}, rest);
  world.muscles = make_muscles(rest, r, {muscle});
  return world;
}

/// All forces of the world in a step of dt (s) without other forces.
void all_forces(const Particles& particles, const World& world, const WorldNow& now, double dt,
                WorldForces& forces) {
  world_forces(particles, world, now, forces);
  Points others(particles.size());
  for (std::size_t i = 0; i < others.size(); ++i) others[i] = forces.total(i);
  stop_sliding(particles, world, now, others, dt, forces);
}

Points velocities_of(const Particles& particles) {
  Points velocities(particles.size());
  for (std::size_t i = 0; i < velocities.size(); ++i) velocities[i] = particles.velocity(i);
  return velocities;
}

void expect_same_bits(const Points& a, const Points& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i], b[i]);
}

TEST(World, ObstaclesFeelWhatTheyDoToBodiesOfAnyNumberOfParticles) {
  const Points whole = test::fcc_ball(20, r);
  World world;
  world.obstacles = busy_world(whole).obstacles;
  for (const std::size_t count : {1, 1023, 1024, 1025, 2047, 2048, 2049}) {
    const Points rest(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(count));
    WorldForces forces;
    world_forces(particles_at(rest, r, 1), world, world_at(world, 0, {}), forces);
    ASSERT_EQ(forces.contact.size(), count);
    Vec3 given = Vec3::Zero(), felt = Vec3::Zero();
    double most = 0;
    for (const Vec3& force : forces.contact) given += force, most += force.norm();
    for (const auto& reaction : forces.reactions) felt += reaction.force;
    EXPECT_GT(most, 0);
    EXPECT_LT((given + felt).norm(), 1e-12 * most) << count;
  }
}

TEST(World, AnEmptyOneDoesNothing) {
  const Particles particles = particles_at(test::fcc_ball(3, r), r, 1);
  WorldForces forces;
  world_forces(particles, {}, world_at({}, 0, {}), forces);
  for (std::size_t i = 0; i < particles.size(); ++i) EXPECT_EQ(forces.total(i), Vec3(0, 0, 0));
  EXPECT_EQ(added_stiffness({}, particles), 0);
  EXPECT_EQ(added_damping({}, particles), 0);
  EXPECT_NO_THROW(check_world({}));
}

/// Work, loss and energies of a run, by the trapezoid rule.
struct Ledger {
  double work = 0, lost = 0, kinetic = 0, contact = 0;
};

/// Follows a loose swarm through the full world for `duration` (s). Each step is half drift, kick,
/// half drift; forces and powers are those of its middle.
Ledger followed(double duration, int steps) {
  const Points rest = test::fcc_ball(5, r);
  const World world = busy_world(rest);
  Particles swarm = test::shaken(rest, test::material_of(test::box_scene()), 0.1 * r, 0.3);
  const double dt = duration / steps;
  const auto drift = [&] {
    for (std::size_t i = 0; i < swarm.size(); ++i)
      swarm.set_position(i, swarm.position(i) + dt / 2 * swarm.velocity(i));
  };
  const auto kinetic = [&] {
    double sum = 0;
    for (std::size_t i = 0; i < swarm.size(); ++i)
      sum += swarm.mass / 2 * swarm.velocity(i).squaredNorm();
    return sum;
  };
  WorldForces forces;
  world_forces(swarm, world, world_at(world, 0, {}), forces);
  Ledger ledger;
  const double at_start = kinetic() + forces.contact_energy;
  for (int step = 0; step < steps; ++step) {
    drift();
    all_forces(swarm, world, world_at(world, (step + 0.5) * dt, {}), dt, forces);
    Points middle = velocities_of(swarm);
    for (std::size_t i = 0; i < swarm.size(); ++i) {
      const Vec3 half = dt / 2 / swarm.mass * forces.total(i);
      middle[i] += half;
      swarm.set_velocity(i, swarm.velocity(i) + 2 * half);
    }
    const WorldPowers powers = world_powers(forces, middle);
    ledger.work += dt * (powers.obstacles + powers.fields + powers.muscles);
    ledger.lost += dt * powers.lost;
    drift();
  }
  world_forces(swarm, world, world_at(world, duration, {}), forces);
  ledger.kinetic = kinetic() - at_start;
  ledger.contact = forces.contact_energy;
  return ledger;
}

TEST(World, WorkIsKineticEnergyContactEnergyAndLoss) {
  const Ledger ledger = followed(0.1, 4000);
  EXPECT_GT(ledger.lost, 0.01);
  EXPECT_GT(ledger.contact, 1e-4);
  EXPECT_NEAR(ledger.kinetic + ledger.contact + ledger.lost, ledger.work, 2e-4 * ledger.lost);
}

/// Whether a particle that balances at `corner` stays there with steps of `dt` (s).
bool rests(const World& world, double mass, const Vec3& corner, double dt) {
  Particles one = particles_at({corner}, r, mass);
  one.set_velocity(0, {1e-5, 2e-5, -1e-5});
  WorldForces forces;
  const WorldNow now = world_at(world, 0, {});
  for (int step = 0; step < 4000; ++step) {
    world_forces(one, world, now, forces);
    one.set_velocity(0, one.velocity(0) + dt / mass * forces.total(0));
    one.set_position(0, one.position(0) + dt * one.velocity(0));
    if (!((one.position(0) - corner).norm() < 0.3 * r)) return false;
  }
  return true;
}

TEST(World, StepsWithinTheLimitOfItsStiffnessAndDampingAreStable) {
  const double mass = 0.005;
  World world;
  // Two walls that face each other, and a floor.
  for (const Vec3& normal : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 0, 1)})
    world.obstacles.push_back(rubbing(PlaneShape{-0.5 * r * normal, normal}));
  const Particles one = particles_at({Vec3::Zero()}, r, mass);
  const double w2 = added_stiffness(world, one) / mass, g = added_damping(world, one);
  EXPECT_NEAR(w2, 450 / mass, 1e-9);
  EXPECT_NEAR(g, 1.8 / mass, 1e-9);
  const double limit = (std::sqrt(g * g + 4 * w2) - g) / w2;
  World pressed = world;
  pressed.fields = {{"press", UniformAcceleration{{0, 0, -150 * 0.5 * r / mass}}, {}, {}}};
  EXPECT_TRUE(rests(pressed, mass, {0, 0, 0}, 0.99 * limit));
  EXPECT_FALSE(rests(pressed, mass, {0, 0, 0}, 4 * limit));
}

TEST(World, LimitsCountTheObstaclesThatAParticleCanMeetAtOnce) {
  World world;
  for (const double k : {1.0, 5.0, 2.0, 4.0, 3.0}) {
    world.obstacles.push_back(rubbing(PlaneShape{}));
    world.obstacles.back().stiffness = k;
  }
  const Particles one = particles_at({Vec3::Zero()}, r, 2);
  EXPECT_EQ(added_stiffness(world, one), 12);
  EXPECT_NEAR(added_damping(world, one), 3 * 0.6 / 2, 1e-15);
  world.drag.rate = 7;
  for (Obstacle& obstacle : world.obstacles) obstacle.friction = 0;
  EXPECT_NEAR(added_damping(world, one), 7 + 3 * 0.4 / 2, 1e-15);
}

TEST(World, WhatIsWrongIsRefused) {
  World world;
  world.obstacles = {rubbing(SphereShape{{0, 0, 0}, -1})};
  test::expect_bad_input([&] { check_world(world); }, {"obstacle 'wall'", "radius of -1"});
  world = {};
  world.drag.rate = NAN;
  test::expect_bad_input([&] { check_world(world); }, {"drag has a rate of"});
}

}  // namespace sinew::world_test

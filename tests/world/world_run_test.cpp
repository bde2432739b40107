// SPDX-License-Identifier: GPL-3.0-or-later
// Whole bodies among obstacles, pins, fields and muscles.
#include <gtest/gtest.h>

#include <sinew/scene/prepare.h>
#include <sinew/scene/rig.h>
#include <sinew/stepping/simulation.h>
#include <sinew/world/world.h>

#include "support/world.h"

namespace sinew::world_run_test {

constexpr double r = 0.01;

/// A small upright box of the scene's particles, free or on its bones, in a world.
class Box {
 public:
  explicit Box(bool bound = false, int height = 9) : rest(test::fcc_box(5, 5, height, r)) {
    settings = test::box_scene(height);
    settings.material.damping_form = DampingForm::symmetric;
    if (!bound) settings = test::unbound(settings);
    const Material material = test::material_of(settings);
    stiffness = material.pair.contact_stiffness();
    mass = material.mass;
  }

  Obstacle obstacle(const Shape& shape, double friction = 0) const {
    Obstacle made;
    made.name = "wall";
    made.shape = shape;
    made.stiffness = stiffness;
    made.damping = 0.5 * std::sqrt(stiffness * mass);
    made.friction = friction;
    return made;
  }

  Simulation run(double duration = 0) const {
    Body body = test::make_body(settings, rest);
    body.world = std::make_shared<const World>(world);
    Particles particles = particles_at(rest, r, mass);
    const WorldLoad load = {added_stiffness(world, particles), added_damping(world, particles)};
    const double step = fraction_of_limit *
                        step_limit(settings.solver.integrator, body.material, body.springs, load);
    for (std::size_t i = 0; i < rest.size(); ++i) particles.set_velocity(i, velocity);
    Simulation simulation(body, motion_of(settings, body.skeleton), particles,
                          stepping_of(settings.solver, step));
    while (simulation.time() < duration) simulation.step();
    return simulation;
  }

  /// Runs, and keeps the balance of energies within a fraction of the work or losses.
  Energies balanced(double duration) const {
    Simulation simulation = run();
    const Energies start = simulation.energies();
    while (simulation.time() < duration) simulation.step();
    const Energies end = simulation.energies();
    const double lost = end.dissipation - start.dissipation;
    const double turned_over = std::max({std::abs(end.work()), lost, std::abs(end.work_of_world)});
    EXPECT_NEAR(end.stored() - start.stored(), end.work() - lost, 0.005 * turned_over);
    EXPECT_GT(turned_over, 0);
    return end;
  }

  Points rest;
  Settings settings;
  World world;
  double stiffness = 0, mass = 0;
  double fraction_of_limit = 0.5;
  Vec3 velocity = Vec3::Zero();
};

Vec3 mean_velocity(const Particles& particles) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < particles.size(); ++i) sum += particles.velocity(i);
  return sum / static_cast<double>(particles.size());
}

ObstacleMotion moving(const Vec3& velocity) {
  return [velocity](double time, const Pose&) {
    return ObstaclePose{{time * velocity, Mat3::Identity()}, velocity, Vec3::Zero()};
  };
}

TEST(WorldRun, AnEmptyWorldChangesNoBit) {
  Box box(true);
  box.settings.tracks = {test::track("upper", {test::bend_key(0, 0), test::bend_key(0.1, 20)})};
  const Simulation with = box.run(0.05);
  Body body = test::make_body(box.settings, box.rest);
  const double step = 0.5 * step_limit(Integrator::symplectic_euler, body.material, body.springs);
  Simulation without(body, motion_of(box.settings, body.skeleton),
                     particles_at(box.rest, r, box.mass), stepping_of(box.settings.solver, step));
  while (without.time() < 0.05) without.step();
  EXPECT_EQ(with.particles().x, without.particles().x);
  EXPECT_EQ(with.particles().w, without.particles().w);
}

TEST(WorldRun, ABodyFallsOnAFloorAndRests) {
  Box box;
  box.settings.solver.gravity = {0, 0, -9.81};
  box.settings.material.damping = 2;  // the body's own vibration decays sooner
  box.world.obstacles = {box.obstacle(PlaneShape{{0, 0, -2.5 * r}, {0, 0, 1}}, 0.5)};
  const Energies end = box.balanced(0.8);
  EXPECT_GT(end.contact, 0);
  Simulation rested = box.run(0.8);
  EXPECT_LT(mean_velocity(rested.particles()).norm(), 1e-3);
  const double weight = 9.81 * box.mass * static_cast<double>(box.rest.size());
  EXPECT_NEAR(rested.reactions_of_obstacles()[0].force.z(), -weight, 0.02 * weight);
}

TEST(WorldRun, FrictionHoldsABodyOnAnIncline) {
  Box box(false, 5);
  box.settings.solver.gravity = {2, 0, -9.6};
  const auto speed = [&](double friction) {
    box.world.obstacles = {box.obstacle(PlaneShape{{0, 0, -0.2 * r}, {0, 0, 1}}, friction)};
    return mean_velocity(box.run(0.5).particles()).x();
  };
  EXPECT_NEAR(speed(0), 2 * 0.5, 0.02);
  EXPECT_NEAR(speed(0.1), (2 - 0.1 * 9.6) * 0.5, 0.05);
  EXPECT_LT(std::abs(speed(0.4)), 0.02);
}

TEST(WorldRun, AMovingWallDoesTheWorkItGives) {
  Box box;
  Obstacle wall = box.obstacle(PlaneShape{{-6 * r, 0, 0}, {1, 0, 0}});
  wall.motion = moving({0.3, 0, 0});
  box.world.obstacles = {wall};
  const Energies end = box.balanced(0.4);
  EXPECT_GT(end.work_of_world, 0);
  EXPECT_GT(mean_velocity(box.run(0.4).particles()).x(), 0.25);
}

TEST(WorldRun, PinsHoldWhatTheyHave) {
  Box box;
  box.settings.solver.gravity = {0.5, 0, 0};
  box.world.pins = pinned(box.rest, {{{BoxShape{{0, 0, 0}, {1, 1, 2 * r}}, 0}, no_bone}}, 2);
  box.balanced(0.2);
  const Simulation simulation = box.run(0.2);
  for (const Pinned& pin : box.world.pins)
    EXPECT_EQ(simulation.particles().position(pin.particle), box.rest[pin.particle]);
  double most = 0;
  for (std::size_t i = 0; i < box.rest.size(); ++i)
    most = std::max(most, (simulation.particles().position(i) - box.rest[i]).norm());
  EXPECT_GT(most, 0.1 * r);
  EXPECT_LT(most, 2 * r);
}

TEST(WorldRun, PinsOnBonesMoveAndDoTheirWork) {
  for (const auto integrator : {Integrator::symplectic_euler, Integrator::velocity_verlet}) {
    Box box;
    box.settings.solver.integrator = integrator;
    box.settings.tracks = {test::track("upper", {test::bend_key(0, 0), test::bend_key(0.3, 30)})};
    const double top = box.rest.back().z();
    box.world.pins = pinned(box.rest,
                            {{{BoxShape{{0, 0, 0}, {1, 1, 2 * r}}, 0}, no_bone},
                             {{BoxShape{{0, 0, top}, {1, 1, 2 * r}}, 0}, 1}},
                            2);
    const Energies end = box.balanced(0.3);
    EXPECT_GT(end.work_of_world, 0);
    const Simulation simulation = box.run(0.3);
    const Pinned& last = box.world.pins.back();
    const PinPose place =
        pin_pose(last, box.rest[last.particle], simulation.body().skeleton, simulation.pose());
    EXPECT_EQ(last.bone, 1);
    EXPECT_EQ(simulation.particles().position(last.particle), place.position);
  }
}

TEST(WorldRun, FieldsAndMusclesDoTheWorkTheyGive) {
  Box box;
  box.fraction_of_limit = 0.2;  // the balance closes to second order; a twitch is fast
  box.world.fields = {{"wind", UniformAcceleration{{2, 0, 0}}, {}, {{0, 0.1}, {0, 1}}}};
  Muscle muscle;
  muscle.strength = 1000;
  muscle.activation = {{0, 0.05}, {0, 1}};
  muscle.weights = weights_in({}, box.rest);
  box.world.muscles = make_muscles(box.rest, r, {muscle});
  box.balanced(0.2);
  const Particles now = box.run(0.2).particles();
  EXPECT_NEAR(mean_velocity(now).x(), 2 * (0.05 + 0.1), 0.005);
  const double height = now.position(now.size() - 1).z() - now.position(0).z();
  EXPECT_LT(height, 0.97 * (box.rest.back().z() - box.rest.front().z()));
}

TEST(WorldRun, DragBrakesExponentially) {
  Box box;
  box.velocity = {0.4, 0, 0};
  box.world.drag.rate = 3;
  box.balanced(0.3);
  EXPECT_NEAR(mean_velocity(box.run(0.3).particles()).x(), 0.4 * std::exp(-0.9), 2e-3);
}

TEST(WorldRun, ForcesOfTheWorldArePartOfTheTotal) {
  Box box;
  box.world.fields = {{"wind", UniformAcceleration{{2, 0, 0}}, {}, {}}};
  Simulation simulation = box.run();
  const Forces& forces = simulation.forces();
  ASSERT_EQ(forces.world.size(), box.rest.size());
  EXPECT_NEAR(forces.world[3].x(), 2 * box.mass, 1e-15);
  EXPECT_NEAR((forces.total(3) - forces.world[3]).norm(), 0, 1e-12);
}

/// Whether a body pressed between three walls stays at rest at this fraction of the limit.
bool rests(double fraction) {
  Box box(false, 5);
  box.settings.solver.gravity = {-2, -2, -2};
  const double side = 2 * half_plane_spacing(r) + r, bottom = half_plane_spacing(r) / 2 - r;
  const Shape walls[] = {PlaneShape{{0, 0, bottom}, {0, 0, 1}},
                         PlaneShape{{-side, 0, 0}, {1, 0, 0}},
                         PlaneShape{{0, -side, 0}, {0, 1, 0}}};
  for (const Shape& wall : walls) box.world.obstacles.push_back(box.obstacle(wall));
  Body body = test::make_body(box.settings, box.rest);
  body.world = std::make_shared<const World>(box.world);
  Particles particles = particles_at(box.rest, r, box.mass);
  for (std::size_t i = 0; i < box.rest.size(); ++i)
    particles.set_velocity(i, 1e-3 * Vec3(std::sin(7.0 * i), std::cos(5.0 * i), -1));
  const WorldLoad load = {added_stiffness(box.world, particles),
                          added_damping(box.world, particles)};
  const double limit = step_limit(Integrator::symplectic_euler, body.material, body.springs, load);
  Simulation simulation(body, {}, particles, stepping_of(box.settings.solver, fraction * limit));
  try {
    for (int step = 0; step < 3000; ++step) simulation.step();
  } catch (const Error&) {
    return false;
  }
  return simulation.energies().kinetic < 1e-6;
}

TEST(WorldRun, TheStepLimitCountsTheObstacles) { EXPECT_TRUE(rests(0.99)); }

}  // namespace sinew::world_run_test

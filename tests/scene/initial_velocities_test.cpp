// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies that begin with a velocity, among obstacles and each other.
#include <gtest/gtest.h>

#include <sinew/scene/prepare.h>
#include <sinew/settings/read_scene.h>
#include <sinew/stepping/simulation.h>

#include "support/expect_error.h"
#include "support/temp_folder.h"

namespace sinew::initial_velocities_test {

/// A cube of 0.12 m around a point.
std::string cube(double x = 0) {
  std::string text;
  for (int corner = 0; corner < 8; ++corner) {
    const auto at = [&](int k) { return (corner >> k & 1) != 0 ? 0.06 : -0.06; };
    text += "v " + std::to_string(x + at(0)) + ' ' + std::to_string(at(1)) + ' ' +
            std::to_string(at(2)) + '\n';
  }
  return text + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
}

Prepared prepared(const std::string& body, const std::string& rest) {
  const TempFolder folder;
  folder.write("cube.obj", cube());
  folder.write("other.obj", cube(0.15));
  return prepare({read_scene(
      folder.write("scene.yaml", "body: {mesh: cube.obj, radius: 0.01, " + body + "}\n" + rest))});
}

const std::string bonded = "material: {model: bonded, young_modulus: 1e5, damping: 0}\n";

struct Sums {
  double mass = 0;
  Vec3 center = Vec3::Zero(), momentum = Vec3::Zero(), angular = Vec3::Zero();
};

Sums sums_of(const Simulation& simulation) {
  const Particles& now = simulation.particles();
  Sums sums;
  for (std::size_t i = 0; i < now.size(); ++i) {
    sums.mass += now.mass;
    sums.center += now.mass * now.position(i);
    sums.momentum += now.mass * now.velocity(i);
    sums.angular += now.mass * now.position(i).cross(now.velocity(i));
  }
  sums.center /= sums.mass;
  return sums;
}

/// Runs to the end, which is that of the last frame.
Simulation run(const Prepared& scene) {
  Simulation simulation = start(scene);
  simulation.advance(scene.plan.steps_until(scene.frames.count));
  return simulation;
}

const Vec3 thrown(1, 0.5, 2);

TEST(InitialVelocities, AThrownBodyFollowsTheParabola) {
  for (const char* integrator : {"symplectic_euler", "velocity_verlet"}) {
    const Prepared scene = prepared(
        "velocity: [1, 0.5, 2]", bonded + "solver: {duration: 0.3, gravity: [0, 0, -9.81], " +
                                     "integrator: " + integrator + "}\noutput: {interval: 0.1}\n");
    const Sums begun = sums_of(start(scene)), end = sums_of(run(scene));
    const Vec3 gravity(0, 0, -9.81);
    EXPECT_LT((begun.momentum - begun.mass * thrown).norm(), 1e-12 * begun.momentum.norm());
    const Vec3 momentum = begun.mass * (thrown + 0.3 * gravity);
    EXPECT_LT((end.momentum - momentum).norm(), 1e-9 * begun.momentum.norm());
    // The first half step of gravity is missing or too much.
    const double step = scene.steps.step;
    const Vec3 place = begun.center + 0.3 * thrown + 0.045 * gravity;
    EXPECT_LT((end.center - place).norm(), 0.51 * step * 0.3 * 9.81);
  }
}

TEST(InitialVelocities, ASpinIsAboutTheCenterAndKeepsItsAngularMomentum) {
  const Prepared scene = prepared("offset: [0.3, 0.2, 0.1], angular_velocity: [0, 0, 720]",
                                  bonded + "solver: {duration: 0.2}\noutput: {interval: 0.1}\n");
  Simulation simulation = start(scene);
  const Sums begun = sums_of(simulation);
  double inertia = 0;
  for (const Vec3& rest : scene.body.rest)
    inertia += begun.mass / static_cast<double>(scene.body.rest.size()) *
               (rest - begun.center).head<2>().squaredNorm();
  EXPECT_LT(begun.momentum.norm(), 1e-12);
  EXPECT_NEAR(begun.angular.z(), inertia * radians(720), 1e-12 * begun.angular.norm());
  const Sums end = sums_of(run(scene));
  EXPECT_LT((end.angular - begun.angular).norm(), 1e-9 * begun.angular.norm());
  EXPECT_LT((end.center - begun.center).norm(), 1e-12);
}

TEST(InitialVelocities, ABodyBouncesOffAWall) {
  const Prepared scene = prepared(
      "velocity: [0.5, 0, 0]", bonded +
                                   "world: {obstacles: [{name: wall, shape: plane, point: [0.1, 0, "
                                   "0], normal: [-1, 0, 0], damping: 0}]}\n"
                                   "solver: {duration: 0.2}\noutput: {interval: 0.1}\n");
  Simulation simulation = start(scene);
  const Sums begun = sums_of(simulation);
  const Energies before = simulation.energies();
  double impulse = 0;
  const double step = simulation.stepping().step;
  for (auto left = scene.plan.steps_until(scene.frames.count); left > 0; --left) {
    impulse += step * simulation.reactions_of_obstacles()[0].force.x();
    simulation.step();
  }
  const Sums end = sums_of(simulation);
  const Energies after = simulation.energies();
  EXPECT_LT(end.momentum.x(), -0.5 * begun.momentum.x());
  EXPECT_NEAR(begun.momentum.x() - end.momentum.x(), impulse, 1e-9 * impulse);
  EXPECT_NEAR(after.stored() + after.dissipation, before.stored(), 0.005 * before.stored());
  EXPECT_EQ(after.contact, 0);
}

TEST(InitialVelocities, BodiesThatMeetKeepTheirMomentum) {
  const Prepared scene =
      prepared("velocity: [0.3, 0, 0]",
               "bodies: [{mesh: other.obj, velocity: [-0.6, 0, 0], "
               "angular_velocity: [0, 90, 0]}]\n" +
                   bonded + "solver: {duration: 0.1}\noutput: {interval: 0.1}\n");
  const Sums begun = sums_of(start(scene));
  EXPECT_NEAR(begun.momentum.x(), -0.15 * begun.mass, 1e-9 * begun.mass);
  Simulation simulation = run(scene);
  const Sums end = sums_of(simulation);
  EXPECT_LT((end.momentum - begun.momentum).norm(), 1e-11 * begun.mass);
  EXPECT_LT((end.angular - begun.angular).norm(), 1e-9 * begun.angular.norm());
  const Points now = positions_by_id(simulation.particles());
  Vec3 moved = Vec3::Zero();
  for (std::size_t i = 0; i < now.size(); ++i)
    if (scene.body.rest[i].x() < 0.07) moved += now[i] - scene.body.rest[i];
  EXPECT_LT(moved.x(), 0) << "the first is thrown back";
}

TEST(InitialVelocities, GroupsBeginWithThem) {
  const std::string bones =
      "skeleton: {bones: [{name: a, head: [0, 0, -0.06], tail: [0, 0, 0.06]}]}\n"
      "hierarchy: {enabled: true, min_particles: 64}\n";
  const Prepared scene =
      prepared("velocity: [1, 0.5, 2], angular_velocity: [90, 0, 45]", bonded + bones);
  ASSERT_GT(scene.body.grouping->grouped(), 100u);
  const Sums grouped = sums_of(start(scene));
  Prepared free = scene;
  free.body.grouping.reset();
  const Sums each = sums_of(start(free));
  EXPECT_LT((grouped.momentum - each.momentum).norm(), 1e-10 * each.momentum.norm());
  EXPECT_LT((grouped.angular - each.angular).norm(), 1e-10 * each.momentum.norm());
}

TEST(InitialVelocities, ABodyRelaxesInItsFirstPoseBeforeItIsThrown) {
  const Prepared scene = prepared(
      "velocity: [1, 0.5, 2]",
      bonded +
          "skeleton: {bones: [{name: a, head: [0, 0, -0.06], tail: [0, 0, 0]}, "
          "{name: b, parent: a, tail: [0, 0, 0.06]}]}\n"
          "motion: {begin: pose, tracks: [{bone: b, keys: [{time: 0, axis: [0, 1, 0], angle: 20}, "
          "{time: 1, axis: [0, 1, 0], angle: 25}]}]}\n");
  ASSERT_TRUE(scene.beginning.posed);
  const Simulation simulation = start(scene);
  const Particles& now = simulation.particles();
  double turned = 0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    EXPECT_LT((now.velocity(i) - thrown).norm(), 1e-12);
    turned = std::max(turned, (now.position(i) - scene.body.rest[i]).norm());
  }
  EXPECT_GT(turned, 0.01);
}

TEST(InitialVelocities, EquilibriaHaveNone) {
  const auto refused = [](const std::string& body, const std::string& rest = {}) {
    return [=] {
      prepared(body, rest +
                         "loads: [{name: l, force: [0, 0, 1]}]\n"
                         "solver: {method: static}\n");
    };
  };
  test::expect_bad_input(refused("velocity: [1, 0, 0]"),
                         {"initial velocities", "set solver.method to dynamic"});
  test::expect_bad_input(refused("angular_velocity: [1, 0, 0]"),
                         {"initial velocities and equilibria"});
  test::expect_bad_input(
      refused("keep: center", "bodies: [{mesh: other.obj, velocity: [1, 0, 0]}]\n"),
      {"scene.yaml:", "initial velocities and equilibria"});
}

}  // namespace sinew::initial_velocities_test

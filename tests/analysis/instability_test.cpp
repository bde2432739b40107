// SPDX-License-Identifier: GPL-3.0-or-later
// A run that becomes unstable names the cause and a cure that works.
#include <gtest/gtest.h>

#include <sinew/core/error.h>
#include <sinew/scene/rig.h>
#include <sinew/stepping/simulation.h>
#include <sinew/world/world.h>

#include "support/world.h"

namespace sinew::instability_test {

constexpr double r = 0.01;

struct Scene {
  Settings settings = test::box_scene(25);
  std::optional<World> world;
  double step = 0.001;  ///< s

  /// The error of a time (s) of it; "" for none.
  std::string error_within(double time) const {
    const Points rest = test::fcc_box(7, 7, 25, r);
    Body body = test::make_body(settings, rest);
    if (world) body.world = std::make_shared<World>(*world);
    Simulation simulation(body, motion_of(settings, body.skeleton),
                          test::shaken(rest, body.material, 0, 1e-6),
                          stepping_of(settings.solver, step));
    try {
      while (simulation.time() < time) simulation.step();
    } catch (const Error& error) {
      EXPECT_EQ(error.exit(), Exit::unstable);
      return error.what();
    }
    return "";
  }
};

/// It fails with these words, and does not with the step that it names.
void expect_cured(Scene scene, const std::vector<std::string>& words, double time) {
  const std::string error = scene.error_within(time);
  for (const std::string& word : words) EXPECT_NE(error.find(word), error.npos) << error;
  const std::string key = "solver.time_step ";
  const auto at = error.find(key);
  ASSERT_NE(at, error.npos) << error;
  scene.step = std::stod(error.substr(at + key.size()));
  EXPECT_EQ(scene.error_within(time), "");
}

TEST(Instability, OfAStepOverTheLimitNamesTheLimit) {
  Scene scene;
  scene.step = 0.0075;
  expect_cured(scene, {"over the limit of the body at rest, 0.00"}, 2);
}

TEST(Instability, OfAStepOverTheLimitDoesNotBlameTheWorld) {
  Scene scene;
  scene.step = 0.03;
  scene.settings.solver.gravity = {0, 0, -9.81};
  expect_cured(scene, {"over the limit of the body at rest, 0.00"}, 0.3);
}

TEST(Instability, OfABoneThatIsTooFastNamesIt) {
  Scene scene;
  scene.settings.tracks = {test::track("upper", {test::bend_key(0, 0), test::bend_key(0.02, 60)})};
  expect_cured(scene, {"bone 'upper' carries it ", " r in one step; slow the motion there"}, 0.03);
}

TEST(Instability, OfGravityInWrongUnitsSaysSo) {
  Scene scene;
  scene.settings.solver.gravity = {0, 0, -9810};
  const std::string error = scene.error_within(1);
  for (const char* word : {"gravity alone moves it ", "give solver.gravity in m/s^2"})
    EXPECT_NE(error.find(word), error.npos) << error;
}

TEST(Instability, OfAnObstacleInTheBodyNamesIt) {
  Scene scene;
  Obstacle ball;
  ball.name = "ball";
  ball.shape = SphereShape{{0, 0, 0.2}, 3 * r};
  ball.stiffness = 500;
  scene.world.emplace();
  scene.world->obstacles = {ball};
  expect_cured(scene, {"obstacle 'ball' pushes it out", "keep it off the body at rest"}, 1);
}

}  // namespace sinew::instability_test

// SPDX-License-Identifier: GPL-3.0-or-later
// What is doubtful in a scene is said before it runs.
#include <sinew/scene/check/needs.h>
#include <sinew/scene/check/rest_trial.h>
#include <sinew/scene/check/warnings.h>

#include <gtest/gtest.h>
#include <sinew/settings/read_scene.h>
#include <algorithm>

#include "support/temp_folder.h"

namespace sinew::check_test {

/// A bar of 0.2 m with a ring of points at each of these heights, capped.
std::string bar(const std::vector<double>& heights) {
  std::string text, faces;
  for (const double z : heights)
    for (const char* corner : {"-.02 -.02", ".02 -.02", ".02 .02", "-.02 .02"})
      text += std::string("v ") + corner + ' ' + std::to_string(z) + '\n';
  const auto quad = [&](int a, int b, int c, int d) {
    for (const int corner : {a, b, c, d})
      faces += (corner == a ? "f " : " ") + std::to_string(corner);
    faces += '\n';
  };
  const int last = static_cast<int>(heights.size()) - 1;
  for (int ring = 0; ring < last; ++ring)
    for (int k = 0; k < 4; ++k)
      quad(4 * ring + k + 1, 4 * ring + (k + 1) % 4 + 1, 4 * ring + (k + 1) % 4 + 5,
           4 * ring + k + 5);
  quad(4, 3, 2, 1);
  quad(4 * last + 1, 4 * last + 2, 4 * last + 3, 4 * last + 4);
  return text + faces;
}

const std::string two_bones =
    "{name: lower, head: [0, 0, 0], tail: [0, 0, 0.1]}, "
    "{name: upper, parent: lower, tail: [0, 0, 0.2]}";

struct Scene {
  std::string mesh, keys = {}, body = "radius: 0.004", bones = two_bones;
};

std::vector<std::string> warnings_of(const Scene& scene) {
  const TempFolder folder;
  folder.write("bar.obj", scene.mesh);
  const auto path =
      folder.write("scene.yaml", "body: {mesh: bar.obj, " + scene.body + "}\nskeleton: {bones: [" +
                                     scene.bones + "]}\n" + scene.keys);
  const Prepared prepared = prepare({read_scene(path)});
  return sinew::warnings_of(prepared, 0);
}

std::vector<std::string> warnings_with(const std::vector<double>& heights,
                                       const std::string& keys) {
  return warnings_of({bar(heights), keys});
}

const std::vector<double> fine = {0, 0.05, 0.1, 0.15, 0.2};

bool told(const std::vector<std::string>& warnings, const std::string& part) {
  return std::any_of(warnings.begin(), warnings.end(), [&](const std::string& warning) {
    return warning.find(part) != std::string::npos;
  });
}

void expect_one(const std::vector<std::string>& warnings, const std::string& part) {
  EXPECT_EQ(warnings.size(), 1u) << part;
  EXPECT_TRUE(told(warnings, part)) << (warnings.empty() ? "" : warnings[0]);
}

std::string bend_by(const std::string& angle) {
  return "motion: {tracks: [{bone: upper, keys: [{time: 0}, {time: 1, axis: [0, 1, 0], angle: " +
         angle + "}]}]}\n";
}

const std::string bending = bend_by("9");

TEST(SceneWarnings, TellOfASurfaceThatCannotBend) {
  const auto warnings = warnings_with({0, 0.2}, bending);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("8 faces"), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[0].find("subdivide"), std::string::npos) << warnings[0];
}

TEST(SceneWarnings, AreSilentWhereItBendsOrNothingMoves) {
  EXPECT_EQ(warnings_with({0, 0.05, 0.1, 0.15, 0.2}, bending), std::vector<std::string>{});
  EXPECT_EQ(warnings_with({0, 0.2}, ""), std::vector<std::string>{});
}

TEST(SceneWarnings, TellOfAnglesInRadians) {
  for (const char* angle : {"1.57", "0.785", "3.14159", "-2.0944"})
    EXPECT_TRUE(told(warnings_with(fine, bend_by(angle)), "in radians")) << angle;
  for (const char* angle : {"90", "4.96", "2", "1.4"})
    EXPECT_FALSE(told(warnings_with(fine, bend_by(angle)), "in radians")) << angle;
  EXPECT_EQ(warnings_with(fine, bend_by("90")), std::vector<std::string>{});
}

TEST(SceneWarnings, TellOfBonesThatMoveNothing) {
  expect_one(warnings_with(fine, bend_by("0.01")), "no bone moves any particle by its radius");
}

TEST(SceneWarnings, TellOfAUnitThatNoBodyHas) {
  const std::string bones = "{name: lower, head: [0, 0, 0], tail: [0, 0, 200]}";
  expect_one(warnings_of({bar(fine), "", "radius: 4, scale: 1000", bones}), "body.unit");
  const std::string small = "{name: lower, head: [0, 0, 0], tail: [0, 0, 2e-4]}";
  expect_one(warnings_of({bar(fine), "", "radius: 4e-6, scale: 1e-3", small}), "body.scale");
}

TEST(SceneWarnings, TellOfBonesThatNothingFollows) {
  expect_one(warnings_of({bar(fine), "", "radius: 0.004",
                          two_bones + ", {name: hat, head: [0.1, 0, 0.6], tail: [0.1, 0, 0.7]}"}),
             "no particle follows 1 of 3 bones ('hat')");
}

TEST(SceneWarnings, TellOfARigOfAnotherSizeOrBesideTheBody) {
  const std::string large =
      "{name: lower, head: [0, 0, 0], tail: [0, 0, 10]}, {name: upper, parent: lower, tail: [0, 0, "
      "20]}";
  EXPECT_TRUE(
      told(warnings_of({bar(fine), "", "radius: 0.004", large}), "times as large as the body"));
  const std::string beside =
      "{name: lower, head: [1, 0, 0], tail: [1, 0, 0.1]}, {name: hat, parent: lower, tail: [1.1, "
      "0, "
      "0.1]}";
  EXPECT_TRUE(told(warnings_of({bar(fine), "", "radius: 0.004", beside}), "beside the body"));
}

TEST(SceneWarnings, TellOfABodyOfOneOrTwoLayers) {
  expect_one(warnings_of({bar(fine), "", "radius: 0.015"}), "one or two layers");
  EXPECT_EQ(warnings_of({bar(fine), "", "radius: 0.007"}), std::vector<std::string>{});
}

/// Boxes of these corners, each closed.
std::string boxes(const std::vector<std::array<Vec3, 2>>& all) {
  std::string text;
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (int corner = 0; corner < 8; ++corner) {
      text += 'v';
      for (int k = 0; k < 3; ++k) text += ' ' + std::to_string(all[i][corner >> k & 1][k]);
      text += '\n';
    }
    for (const auto& face : {std::array{0, 2, 3, 1},
                             {4, 5, 7, 6},
                             {0, 1, 5, 4},
                             {2, 6, 7, 3},
                             {0, 4, 6, 2},
                             {1, 3, 7, 5}}) {
      text += 'f';
      for (const int corner : face) text += ' ' + std::to_string(8 * i + corner + 1);
      text += '\n';
    }
  }
  return text;
}

/// Two legs on a base, with a gap between them.
Scene legs(double gap, const std::string& keys) {
  Scene scene;
  scene.mesh = boxes({{Vec3(-0.05, -0.02, 0), Vec3(0.05, 0.02, 0.04)},
                      {Vec3(-0.05, -0.02, 0.02), Vec3(-gap / 2, 0.02, 0.2)},
                      {Vec3(gap / 2, -0.02, 0.02), Vec3(0.05, 0.02, 0.2)}});
  scene.bones =
      "{name: base, head: [-0.04, 0, 0.02], tail: [0.04, 0, 0.02]}, "
      "{name: left, parent: base, head: [-0.03, 0, 0.05], tail: [-0.03, 0, 0.2]}, "
      "{name: right, parent: base, head: [0.03, 0, 0.05], tail: [0.03, 0, 0.2]}";
  scene.body = "radius: 0.004, lattice_origin: [0.0028, 0, 0]";  // no plane of sites in the gap
  scene.keys = keys;
  return scene;
}

const std::string closing =
    "motion: {tracks: [{bone: left, keys: [{time: 0}, {time: 1, axis: [0, 1, 0], angle: 12}]}]}\n";

TEST(SceneWarnings, TellOfLegsThatTouchAcrossAGap) {
  const std::string across = "'left' and 'right' touch across a gap";
  EXPECT_TRUE(told(warnings_of(legs(0.003, "")), across));
  EXPECT_FALSE(told(warnings_of(legs(0.02, "")), across));
  EXPECT_FALSE(told(warnings_of(legs(-0.002, "")), across));  // the legs are one
}

TEST(SceneWarnings, TellOfLegsThatMeetAndStick) {
  const std::string advice = "initial_neighbors, or material.model to bonded";
  EXPECT_TRUE(told(warnings_of(legs(0.02, closing)), advice));
  EXPECT_FALSE(told(warnings_of(legs(0.06, closing)), advice));
  for (const char* material : {"cohesion: initial_neighbors", "model: bonded"})
    EXPECT_FALSE(told(warnings_of(legs(0.02, closing + "material: {" + material + "}\n")), advice))
        << material;
}

/// A bar of the paper's model whose second neighbors pull.
RestTrial trial_of(const std::string& keys, const std::string& b = "2.8284") {
  const TempFolder folder;
  folder.write("bar.obj", bar(fine));
  const std::string material = "material: {young_modulus: 1e4, lambda: 0.05, b: " + b + "}\n";
  return try_rest(prepare({read_scene(
      folder.write("scene.yaml", "body: {mesh: bar.obj, radius: 0.006}\n" + material + keys))}));
}

TEST(RestTrial, WarnsOfABodyThatItsBonesDoNotHold) {
  const std::string held = "skeleton: {bones: [" + two_bones +
                           "]}\nbinding: {stiffness: 1e-3, twist_stiffness: 1e-3, "
                           "axial_stiffness: 1e-3}\n";
  const RestTrial trial = trial_of(held);
  EXPECT_EQ(trial.state, RestState::unstable) << text_of(trial);
  EXPECT_NE(warning_of(trial).find("set material.b to 2.75"), std::string::npos)
      << warning_of(trial);
  EXPECT_EQ(warning_of(trial_of(held, "2.75")), "");
}

TEST(RestTrial, IsOfBodiesWithoutBonesToo) {
  for (const char* around : {"loads: [{name: push, force: [0.02, 0, 0]}]\n",
                             "world: {obstacles: [{name: floor, shape: plane}]}\n"})
    EXPECT_GT(trial_of(around).particles, 0u);
}

}  // namespace sinew::check_test

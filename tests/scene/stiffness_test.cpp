// SPDX-License-Identifier: GPL-3.0-or-later
// The stiffness between supports and loads is told by how they strain the body, and the modulus
// that a probe shows where its stress is uniaxial.
#include <sinew/run/probe_table.h>
#include <sinew/scene/check/stiffness.h>

#include <gtest/gtest.h>
#include <sinew/settings/read_scene.h>
#include <cmath>

#include "support/temp_folder.h"

namespace sinew::stiffness_test {

/// An upright bar of 0.2 m and a section of 0.04 m by 0.04 m.
constexpr const char* bar =
    "v -.02 -.02 0\nv .02 -.02 0\nv .02 .02 0\nv -.02 .02 0\n"
    "v -.02 -.02 .2\nv .02 -.02 .2\nv .02 .02 .2\nv -.02 .02 .2\n"
    "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

Prepared prepared_with(const std::string& machine, const std::string& model = "paper") {
  const TempFolder folder;
  folder.write("bar.obj", bar);
  return prepare({read_scene(folder.write(
      "scene.yaml", "body: {mesh: bar.obj, radius: 0.004}\nmaterial: {model: " + model +
                        ", young_modulus: 1e5}\n" + machine))});
}

std::vector<SpanStiffness> spans_of(const std::string& machine) {
  return stiffness_between_grips(prepared_with(machine));
}

std::string grips(const std::string& hold, const std::string& key) {
  return "supports: [{name: below, facing: [0, 0, -1]}, {name: above, hold: " + hold +
         ", facing: [0, 0, 1], keys: [{time: 0}, {time: 1, " + key + "}]}]\n";
}

const std::string clamp = "supports: [{name: below, facing: [0, 0, -1]}]\n";

TEST(Stiffness, BetweenSupportsIsThatOfTheirStrain) {
  const auto pulled = spans_of(grips("z", "translation: [0, 0, 0.001]"));
  ASSERT_EQ(pulled.size(), 1u);
  EXPECT_FALSE(pulled[0].bends);
  EXPECT_NEAR(pulled[0].young_modulus, 1e5 * 0.9428 / 1.3505, 10);  // along [100]
  EXPECT_NEAR(pulled[0].planes, 0.04 / (0.004 * std::sqrt(2)), 0.3);
  for (const char* key : {"translation: [0.001, 0, 0]", "axis: [0, 1, 0], angle: 3"}) {
    const auto bent = spans_of(grips("xyz", key));
    ASSERT_EQ(bent.size(), 1u) << key;
    EXPECT_TRUE(bent[0].bends) << key;
    EXPECT_LT(bent[0].shown_modulus(), pulled[0].shown_modulus());
  }
}

TEST(Stiffness, IsNotToldWhereNothingIsStrainedAlong) {
  EXPECT_TRUE(spans_of(grips("z", "translation: [0, 0, 0]")).empty());
  EXPECT_TRUE(spans_of(grips("xy", "translation: [0, 0, 0.001]")).empty());
  EXPECT_TRUE(spans_of(grips("xyz", "axis: [0, 0, 1], angle: 20")).empty());  // by G
  EXPECT_TRUE(spans_of(clamp + "loads: [{name: sea, pressure: 100}]\n").empty());
}

TEST(Stiffness, BetweenSupportsAndLoadsIsThatOfTheForce) {
  const auto bends = [](const std::string& load) {
    const auto spans = spans_of(clamp + load);
    EXPECT_EQ(spans.size(), 1u) << load;
    return !spans.empty() && spans[0].bends;
  };
  EXPECT_TRUE(bends("loads: [{name: tip, force: [1, 0, 0], facing: [0, 0, 1]}]\n"));
  EXPECT_FALSE(bends("loads: [{name: tip, force: [0, 0, 1], facing: [0, 0, 1]}]\n"));
  EXPECT_FALSE(bends("loads: [{name: end, pressure: 100, facing: [0, 0, 1]}]\n"));
  EXPECT_TRUE(bends("solver: {gravity: [9.81, 0, 0]}\n"));
  EXPECT_EQ(spans_of("loads: [{name: up, traction: [0, 0, 9], facing: [0, 0, 1]}, {name: down, "
                     "traction: [0, 0, -9], facing: [0, 0, -1]}]\n")
                .size(),
            1u);
}

TEST(Stiffness, WarnsWhereTheMaterialIsSofterThanAsked) {
  const std::string pull = grips("z", "translation: [0, 0, 0.001]");
  for (const auto& [model, warned] : {std::pair("paper", 1u), {"bonded", 0u}}) {
    std::vector<std::string> warnings;
    warn_of_stiffness(prepared_with(pull, model), warnings);
    EXPECT_EQ(warnings.size(), warned) << model;
  }
}

using Tensor = std::array<double, 6>;

/// A stress along a direction, with `beside` of it across.
Tensor along(const Vec3& axis, double stress, double beside = 0) {
  const Vec3 n = axis.normalized(), m = n.unitOrthogonal();
  const Mat3 all = stress * (n * n.transpose() + beside * m * m.transpose());
  return {all(0, 0), all(1, 1), all(2, 2), all(0, 1), all(1, 2), all(0, 2)};
}

TEST(ShownModulus, IsStressOverStrainAlongTheAxis) {
  const Vec3 axis(1, 2, -0.5);
  for (const double stretch : {1.01, 0.98}) {
    const double green = (stretch * stretch - 1) / 2;
    Tensor strain = along(axis, green);
    for (int k = 0; k < 3; ++k) strain[k] -= 0.25 * green;
    const auto found = uniaxial(along(axis, 1e5 * (stretch - 1)), strain);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->first, 1e5 * (stretch - 1), 1e-6);
    EXPECT_NEAR(found->second, std::sqrt(1 + 1.5 * green) - 1, 1e-12);
  }
}

TEST(ShownModulus, IsOfUniaxialStressAlone) {
  const Tensor strain = along(Vec3::UnitX(), 0.01);
  EXPECT_TRUE(uniaxial(along(Vec3::UnitX(), 100, 0.04), strain));
  EXPECT_FALSE(uniaxial(along(Vec3::UnitX(), 100, 0.06), strain));
  EXPECT_FALSE(uniaxial(Tensor{100, 100, 100, 0, 0, 0}, strain));
  EXPECT_FALSE(uniaxial(Tensor{0, 0, 0, 50, 0, 0}, strain));    // shear
  EXPECT_FALSE(uniaxial(along(Vec3::UnitX(), 100), Tensor{}));  // no strain
  EXPECT_FALSE(uniaxial(along(Vec3::UnitX(), -100), strain));   // another sign
  EXPECT_FALSE(uniaxial(Tensor{std::nan(""), 0, 0, 0, 0, 0}, strain));
}

}  // namespace sinew::stiffness_test

// SPDX-License-Identifier: GPL-3.0-or-later
// Flesh follows bones that become longer.
#include <gtest/gtest.h>
#include <sinew/scene/prepare.h>
#include <sinew/settings/read_scene.h>

#include "support/source_dir.h"
#include "support/temp_folder.h"

namespace sinew::stretch_test {

constexpr double length = 0.69296465;  // of the box and its bone, m

Prepared prepared(double factor, const std::string& binding = {}) {
  const TempFolder folder;
  const auto path = folder.write(
      "scene.yaml", std::string("body: {mesh: ") + test::source_dir() +
                        "/data/meshes/box.obj, radius: 0.015}\nmaterial: {model: bonded}\n"
                        "skeleton: {bones: [{name: bone, head: [0, 0, 0], tail: [0, 0, " +
                        std::to_string(length) +
                        "]}]}\nmotion: {tracks: [{bone: bone, keys: [{time: 0}, {time: 0.5, "
                        "stretch: " +
                        std::to_string(factor) + "}]}]}\n" + binding);
  return prepare({read_scene(path)});
}

/// Factor of the length of what lies between two heights at rest, in parts of the bone, by a fit.
double factor_between(const Points& rest, const Points& now, double from, double to) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const double at = rest[i].z() / length;
    if (at < from || at > to) continue;
    n += 1, x += at, y += now[i].z() / length;
    xx += at * at, xy += at * now[i].z() / length;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

TEST(Stretch, IsThatOfTheFleshWithinAFewHundredths) {
  for (const double factor : {0.8, 1.2, 1.5}) {
    Prepared scene = prepared(factor);
    const Points rest = scene.body.rest;
    Simulation simulation = start(std::move(scene));
    while (simulation.time() < 1) simulation.step();
    const Points now = positions_by_id(simulation.particles());
    EXPECT_NEAR(factor_between(rest, now, 1 / 3.0, 2 / 3.0), factor, 0.01);
    EXPECT_NEAR(factor_between(rest, now, 0, 1), factor, 0.03);
  }
}

TEST(Stretch, RaisesOnlyTheSpringsThatItNeeds) {
  const BoneSprings still = prepared(1).body.springs[0], longer = prepared(1.2).body.springs[0];
  EXPECT_GT(longer.axial, 5 * still.axial);
  EXPECT_EQ(longer.radial, still.radial);
  EXPECT_EQ(longer.twist, still.twist);
  EXPECT_EQ(longer.damping, still.damping);
  EXPECT_EQ(prepared(1.2, "binding: {axial_stiffness: 0}\n").body.springs[0].axial, 0);
  const double firm = prepared(1.2, "binding: {axial_stiffness: 100}\n").body.springs[0].axial;
  EXPECT_EQ(firm, prepared(1, "binding: {axial_stiffness: 100}\n").body.springs[0].axial);
}

}  // namespace sinew::stretch_test

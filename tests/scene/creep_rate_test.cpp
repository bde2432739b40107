// SPDX-License-Identifier: GPL-3.0-or-later
// The creep rate that a scene has by default.
#include <gtest/gtest.h>
#include <sinew/scene/prepare.h>
#include <sinew/scene/steps.h>
#include <sinew/settings/read_scene.h>

#include "support/source_dir.h"
#include "support/temp_folder.h"

namespace sinew::creep_rate_test {

Prepared prepared(const std::string& material, const std::string& rest) {
  const TempFolder folder;
  const auto path = folder.write(
      "scene.yaml", std::string("body: {mesh: ") + test::source_dir() +
                        "/data/meshes/box.obj, radius: 0.02}\nmaterial: {model: bonded, " +
                        material + "}\nsupports:\n  - {name: foot, facing: [0, 0, -1]}\n" + rest);
  return prepare({read_scene(path)});
}

/// The upper end moves by so much (m) within a second.
std::string pulled_by(double distance) {
  return "  - {name: hand, facing: [0, 0, 1], interpolation: linear, keys: [{time: 0}, {time: 1, "
         "translation: [0, 0, " +
         std::to_string(distance) + "]}]}\n";
}

double rate_of(const std::string& material, const std::string& rest) {
  return prepared(material, rest).body.material.bond.creep_rate;
}

TEST(CreepRate, LeavesTwoPercentOfOverstressAtTheFastestRateOfTheScene) {
  const Prepared scene = prepared("yield_strain: 0.02", pulled_by(0.002));
  const double width = 0.155;  // of the box
  EXPECT_NEAR(strain_rate(scene), 0.002 / width, 0.001 / width);
  const BondStrength& bond = scene.body.material.bond;
  const double overstress = std::sqrt(1.5) * strain_rate(scene) / bond.creep_rate;
  EXPECT_NEAR(overstress / bond.yield_shear, 0.02, 1e-12);
}

TEST(CreepRate, FollowsSpeedYieldAndLoads) {
  const double slow = rate_of("yield_strain: 0.02", pulled_by(0.002));
  EXPECT_NEAR(rate_of("yield_strain: 0.02", pulled_by(0.004)), 2 * slow, 1e-9 * slow);
  EXPECT_NEAR(rate_of("yield_strain: 0.01", pulled_by(0.002)), 2 * slow, 1e-9 * slow);
  const double pressed =
      rate_of("yield_strain: 0.02", "loads: [{name: press, facing: [0, 0, 1], pressure: 500}]\n");
  EXPECT_GT(pressed, slow);
  EXPECT_EQ(rate_of("yield_strain: 0.02", ""), 1);
}

TEST(CreepRate, IsNoFasterThanStepsBear) {
  const Prepared scene = prepared("yield_strain: 0.02", pulled_by(0.2));
  const BondStrength& bond = scene.body.material.bond;
  EXPECT_EQ(bond.creep_rate, 0.5 / scene.steps.step);
  const double overstress = std::sqrt(1.5) * strain_rate(scene) / bond.creep_rate;
  EXPECT_NEAR(stress_above_yield(scene), overstress / bond.yield_shear, 1e-12);
  EXPECT_GT(stress_above_yield(scene), 0.1);
}

TEST(CreepRate, IsTheOneGiven) {
  EXPECT_EQ(rate_of("yield_strain: 0.02, creep_rate: 7", pulled_by(0.002)), 7);
}

}  // namespace sinew::creep_rate_test

// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/analysis/rest_stability.h>

#include <gtest/gtest.h>
#include <cmath>

#include "support/world.h"

namespace sinew::rest_stability_test {

Material material_with(double a, double b, MaterialModel model = MaterialModel::paper) {
  Settings settings = test::box_scene();
  settings.material.a = a;
  settings.material.b = b;
  settings.material.model = model;
  return test::material_of(settings);
}

class Packings : public testing::TestWithParam<Packing> {};
INSTANTIATE_TEST_SUITE_P(Both, Packings, testing::Values(Packing::fcc, Packing::hcp));

TEST_P(Packings, RestBelowTheSecondNeighbors) {
  for (const double b : {2.2, 2.6, 2.75})
    EXPECT_GT(min_rise(material_with(2, b), GetParam()), 0.1) << b;
}

TEST_P(Packings, CollapseWhereSecondNeighborsPull) {
  for (const double b : {2.8284, 2 * std::sqrt(2.0), 2.84, 3.0})
    EXPECT_LT(min_rise(material_with(2, b), GetParam()), -0.1) << b;
}

TEST_P(Packings, SwellWhereNothingPulls) {
  EXPECT_LE(min_rise(material_with(2.1, 2.7), GetParam()), 1e-6);
}

TEST_P(Packings, RestWithBonds) {
  for (const double b : {2.6, 2.8284})
    for (const auto model : {MaterialModel::bonded, MaterialModel::bonded_volume})
      EXPECT_GT(min_rise(material_with(2, b, model), GetParam()), 0.1);
}

TEST_P(Packings, RiseTheSameForAnySize) {
  Settings settings = test::box_scene();
  const double one = min_rise(test::material_of(settings), GetParam());
  settings.body.radius = 0.001;
  EXPECT_NEAR(min_rise(test::material_of(settings), GetParam()), one, 1e-5 * one);
}

TEST(RestStability, ChecksBothPackings) {
  EXPECT_TRUE(rests_stably(material_with(2, 2.6)));
  EXPECT_FALSE(rests_stably(material_with(2, 2 * std::sqrt(2.0))));
  EXPECT_FALSE(rests_stably(material_with(2.1, 2.7)));
}

}  // namespace sinew::rest_stability_test

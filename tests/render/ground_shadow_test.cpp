// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/detail/ground_shadow.h>

#include <gtest/gtest.h>

namespace sinew::ground_shadow_test {

/// A plate of 1 m x 1 m, 0.1 m above the ground.
GroundShadow plate() {
  Points centers;
  for (int i = -25; i <= 25; ++i)
    for (int j = -25; j <= 25; ++j) centers.emplace_back(0.02 * i, 0.02 * j, 0.12);
  return {centers, 0.02};
}

TEST(GroundShadow, IsDarkBelowTheBodyAndFadesAroundItAlikeOnAllSides) {
  const GroundShadow shadow = plate();
  EXPECT_GT(shadow.at({0, 0, 0}), 0.7);
  double before = 1;
  for (const double x : {0.0, 0.45, 0.52, 0.6, 0.7, 1.2}) {
    const double here = shadow.at({x, 0, 0});
    EXPECT_LE(here, before);
    EXPECT_NEAR(here, shadow.at({-x, 0, 0}), 0.06);
    EXPECT_NEAR(here, shadow.at({0, x, 0}), 0.06);
    before = here;
  }
  EXPECT_EQ(before, 0);
}

TEST(GroundShadow, IsPalerFartherBelowAndNothingAbove) {
  const GroundShadow shadow = plate();
  EXPECT_LT(shadow.at({0, 0, -1}), shadow.at({0, 0, 0}));
  EXPECT_EQ(shadow.at({0, 0, 0.3}), 0);
  EXPECT_EQ(GroundShadow({}, 0.1).at({0, 0, 0}), 0);
}

}  // namespace sinew::ground_shadow_test

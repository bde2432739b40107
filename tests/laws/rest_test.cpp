// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "support/world.h"

namespace sinew::rest_test {

TEST(PaperBox, AtRestStaysAtRestFor10000Steps) {
  Simulation simulation =
      test::make_simulation(test::box_scene(), test::fcc_box(11, 11, 49, 0.010));
  ASSERT_EQ(simulation.particles().size(), 2965u);
  while (simulation.steps() < 10000) simulation.step();
  EXPECT_LT(test::largest_speed(simulation.particles()), 1e-13);
}

}  // namespace sinew::rest_test

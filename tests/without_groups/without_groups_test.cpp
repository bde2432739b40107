// SPDX-License-Identifier: GPL-3.0-or-later
// A sinew that was built with SINEW_GROUPS=OFF: this program has its sources in place of the
// room's.
#include <gtest/gtest.h>

#include <sinew/groups/make_grouping.h>
#include "support/expect_error.h"
#include "support/world.h"

namespace sinew::without_groups_test {

constexpr double r = 0.01;

TEST(WithoutGroups, BodiesAreStepped) {
  EXPECT_FALSE(groups_are_built());
  Settings settings = test::box_scene(25);
  settings.solver.gravity = {0, 0, -1};
  Simulation simulation = test::make_simulation(settings, test::fcc_box(7, 7, 25, r));
  const SimulationState start = simulation.save();
  simulation.advance(20);
  EXPECT_GT(simulation.energies().kinetic, 0);
  simulation.restore(start);
  EXPECT_EQ(simulation.steps(), 0);
}

TEST(WithoutGroups, ScenesThatAskForThemAreRefused) {
  for (const bool dynamic : {false, true}) {
    Settings settings = test::box_scene(25);
    settings.hierarchy.enabled = true;
    settings.hierarchy.dynamic = dynamic;
    test::expect_bad_input([&] { test::prepared(settings, test::fcc_box(7, 7, 25, r)); },
                           {"built without groups", "hierarchy.enabled"});
  }
}

}  // namespace sinew::without_groups_test

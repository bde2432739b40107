// SPDX-License-Identifier: GPL-3.0-or-later
// What stays free of groups because it was asked for.
#include <gtest/gtest.h>

#include <sinew/groups/dynamic/dynamic_groups.h>
#include <sinew/groups/kept_free.h>
#include <sinew/groups/static_groups.h>

#include "support/grouped_bar.h"

namespace sinew::kept_free_test {

using namespace groups_test;
namespace {

constexpr int width = 17, height = 97;

Bar bar() {
  Settings settings = test::box_scene(height);
  settings.material.model = MaterialModel::bonded;
  settings.tracks = {test::track("upper", {test::bend_key(0, 0), test::bend_key(1, 20)})};
  return Bar(settings, width, height, [](const Vec3&) { return -1; });
}

Grouping groups_of(const Bar& bar, const AskedFree& asked) {
  GroupSizes sizes{.joint_distance = 0.7, .min_particles = 256};
  sizes.kept_free = kept_free(bar.body, asked);
  return static_groups(bar.body, {false, true}, sizes);
}

TEST(KeptFree, NothingUnlessAskedFor) { EXPECT_TRUE(kept_free(bar().body, {}).empty()); }

TEST(KeptFree, WhatIsNearTheSurfaceOfABox) {
  const Bar bar = kept_free_test::bar();
  const Box box = bounds(bar.rest);
  const double distance = 5 * r;
  const std::vector<std::uint8_t> kept = kept_free(bar.body, {.surface_distance = distance});
  ASSERT_EQ(kept.size(), bar.rest.size());
  const Grouping grouping = groups_of(bar, {.surface_distance = distance});
  EXPECT_GT(grouping.grouped(), 0U);
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const Vec3 in = (bar.rest[i] - box.min()).cwiseMin(box.max() - bar.rest[i]);
    // Sites of a (100) face are at most sqrt(2) r to the side.
    const double least = in.minCoeff() + r,
                 most = std::hypot(in.minCoeff(), std::sqrt(2.0) * r) + r;
    EXPECT_TRUE(kept[i] == 1 || most >= distance) << i;
    EXPECT_TRUE(kept[i] == 0 || least < distance) << i;
    EXPECT_TRUE(kept[i] == 0 || grouping.group[i] < 0) << i;
  }
}

TEST(KeptFree, WhatIsInABox) {
  const Bar bar = kept_free_test::bar();
  const Vec3 low(-1, -1, 0), high(0, 1, 20 * r);
  const Grouping all = groups_of(bar, {}), grouping = groups_of(bar, {.region = Box(low, high)});
  for (std::size_t i = 0; i < bar.rest.size(); ++i)
    EXPECT_EQ(grouping.group[i] < 0, all.group[i] < 0 || Box(low, high).contains(bar.rest[i])) << i;
}

TEST(KeptFree, WhatABoneHolds) {
  const Bar bar = kept_free_test::bar();
  const Grouping all = groups_of(bar, {}), grouping = groups_of(bar, {.bones = {1}});
  EXPECT_EQ(all.size(), 2U);
  EXPECT_EQ(grouping.size(), 1U);
  for (std::size_t i = 0; i < bar.rest.size(); ++i)
    for (const Influence& one : bar.body.binding.of(i))
      EXPECT_TRUE(one.bone != 1 || grouping.group[i] < 0) << i;
}

TEST(KeptFree, ByDynamicGroupsToo) {
  const Bar bar = kept_free_test::bar();
  DynamicOptions options{{.joint_distance = 0.7, .min_particles = 256}, 0.03};
  options.sizes.kept_free = kept_free(bar.body, {.surface_distance = 4 * r});
  Simulation simulation = bar.begin();
  simulation.enable_dynamic_groups(options);
  while (simulation.time() < 0.1) simulation.step();
  const Grouping& grouping = *simulation.body().grouping;
  EXPECT_GT(grouping.grouped(), 0U);
  for (std::size_t i = 0; i < bar.rest.size(); ++i)
    EXPECT_TRUE(options.sizes.kept_free[i] == 0 || grouping.group[i] < 0) << i;
}

}  // namespace
}  // namespace sinew::kept_free_test

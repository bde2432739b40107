// SPDX-License-Identifier: GPL-3.0-or-later
// Subpieces divide the pieces at bones and groups, whatever the order of the particles.
#include <sinew/lists/subpieces.h>

#include <numeric>
#include <set>

#include <sinew/body/grouping.h>
#include <sinew/core/triangles.h>
#include <sinew/groups/make_grouping.h>
#include <sinew/kernel/kernel.h>
#include <sinew/lists/particle_order.h>

#include "support/all_steppers.h"

namespace sinew::subpieces_test {

constexpr double r = 0.01;
constexpr std::size_t block = 16, size = block * kernel::blocks_per_piece;

struct Ordered {
  Body body;
  std::vector<std::int32_t> id;

  int bone(std::size_t k) const { return body.binding.bone(static_cast<std::size_t>(id[k])); }
};

Ordered in_order_at_rest(Body body) {
  Ordered all{std::move(body), {}};
  std::vector<std::int32_t> given(all.body.rest.size());
  std::iota(given.begin(), given.end(), 0);
  for (const std::uint32_t place : order_at_rest(all.body, given)) all.id.push_back(given[place]);
  return all;
}

Ordered in_order_at_rest() {
  return in_order_at_rest(test::make_body(test::box_scene(49), test::fcc_box(11, 11, 49, r)));
}

void expect_division(const Subpieces& subpieces, std::size_t count) {
  const std::size_t pieces = (count + size - 1) / size;
  ASSERT_EQ(subpieces.of_piece.size(), pieces + 1);
  ASSERT_EQ(subpieces.first.size(), subpieces.size() + 1);
  EXPECT_EQ(subpieces.first.front(), 0u);
  EXPECT_EQ(subpieces.first.back(), count);
  for (std::size_t subpiece = 0; subpiece < subpieces.size(); ++subpiece) {
    EXPECT_LT(subpieces.first[subpiece], subpieces.first[subpiece + 1]);
    EXPECT_EQ(subpieces.piece[subpiece], subpieces.first[subpiece] / size);
    EXPECT_EQ(subpieces.piece[subpiece], (subpieces.first[subpiece + 1] - 1) / size);
  }
  for (std::size_t piece = 0; piece < pieces; ++piece)
    EXPECT_EQ(subpieces.first[subpieces.of_piece[piece]], piece * size);
  for (std::size_t k = 0; k < count; k += block) {
    const std::uint32_t subpiece = subpieces.of_block[k / block];
    EXPECT_LE(subpieces.first[subpiece], k);
    EXPECT_GT(subpieces.first[subpiece + 1], k);
  }
}

TEST(Subpieces, AreOfOneBoneInABodyAtRest) {
  const Ordered all = in_order_at_rest();
  const Subpieces subpieces = subpieces_of(all.body, all.id, block);
  expect_division(subpieces, all.id.size());
  EXPECT_EQ(subpieces.size(), (all.id.size() + size - 1) / size + 1);  // the middle piece has two
  for (std::size_t subpiece = 0; subpiece < subpieces.size(); ++subpiece)
    for (std::size_t k = subpieces.first[subpiece]; k < subpieces.first[subpiece + 1]; ++k)
      ASSERT_EQ(all.bone(k), all.bone(subpieces.first[subpiece])) << k;
}

TEST(Subpieces, AreOfOneGroupOrOfOneBoneAndNone) {
  if (!groups_are_built()) GTEST_SKIP() << "built without groups";
  const Points rest = test::fcc_box(11, 11, 49, r);
  Body body = test::make_body(test::box_scene(49), rest);
  const double middle = bounds(rest).center().z();
  std::vector<std::int32_t> group;
  for (const Vec3& X : rest)
    group.push_back(std::abs(X.z() - middle) < 10 * r ? -1 : X.z() < middle ? 0 : 1);
  body.grouping = std::make_shared<const Grouping>(make_grouping(body, group));
  const Ordered all = in_order_at_rest(std::move(body));
  const Subpieces subpieces = subpieces_of(all.body, all.id, block);
  expect_division(subpieces, all.id.size());
  const auto leader = [&](std::size_t k) {
    const std::int32_t own = all.body.grouping->group[static_cast<std::size_t>(all.id[k])];
    return std::pair(own, own < 0 ? all.bone(k) : 0);
  };
  std::set<std::pair<std::int32_t, int>> leaders;
  for (std::size_t subpiece = 0; subpiece < subpieces.size(); ++subpiece) {
    const auto most = leader((subpieces.first[subpiece] + subpieces.first[subpiece + 1]) / 2);
    leaders.insert(most);
    int others = 0;
    for (std::size_t k = subpieces.first[subpiece]; k < subpieces.first[subpiece + 1]; ++k)
      if (leader(k) != most) ++others;
    EXPECT_LT(others, 8) << subpiece;  // a few at either end
  }
  EXPECT_EQ(leaders.size(), 4u);
}

TEST(Subpieces, ArePiecesWhereBonesAlternate) {
  Ordered all = in_order_at_rest();
  std::shuffle(all.id.begin(), all.id.end(), std::mt19937(3));
  const Subpieces subpieces = subpieces_of(all.body, all.id, block);
  expect_division(subpieces, all.id.size());
  EXPECT_EQ(subpieces.size(), subpieces.of_piece.size() - 1);
}

TEST(Subpieces, OfFewParticlesIsOne) {
  Ordered all = in_order_at_rest();
  all.id.resize(5);
  const Subpieces subpieces = subpieces_of(all.body, all.id, block);
  expect_division(subpieces, 5);
  EXPECT_EQ(subpieces.size(), 1u);
}

}  // namespace sinew::subpieces_test

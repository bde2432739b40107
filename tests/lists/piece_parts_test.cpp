// SPDX-License-Identifier: GPL-3.0-or-later
// Parts divide the pieces at bones and groups, whatever the order of the particles.
#include <sinew/lists/piece_parts.h>

#include <numeric>
#include <set>

#include <sinew/body/grouping.h>
#include <sinew/core/triangles.h>
#include <sinew/groups/make_grouping.h>
#include <sinew/kernel/kernel.h>
#include <sinew/lists/particle_order.h>

#include "support/all_steppers.h"

namespace sinew::piece_parts_test {

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

void expect_division(const PieceParts& parts, std::size_t count) {
  const std::size_t pieces = (count + size - 1) / size;
  ASSERT_EQ(parts.of_piece.size(), pieces + 1);
  ASSERT_EQ(parts.first.size(), parts.size() + 1);
  EXPECT_EQ(parts.first.front(), 0u);
  EXPECT_EQ(parts.first.back(), count);
  for (std::size_t part = 0; part < parts.size(); ++part) {
    EXPECT_LT(parts.first[part], parts.first[part + 1]);
    EXPECT_EQ(parts.piece[part], parts.first[part] / size);
    EXPECT_EQ(parts.piece[part], (parts.first[part + 1] - 1) / size);
  }
  for (std::size_t piece = 0; piece < pieces; ++piece)
    EXPECT_EQ(parts.first[parts.of_piece[piece]], piece * size);
  for (std::size_t k = 0; k < count; k += block) {
    const std::uint32_t part = parts.of_block[k / block];
    EXPECT_LE(parts.first[part], k);
    EXPECT_GT(parts.first[part + 1], k);
  }
}

TEST(PieceParts, AreOfOneBoneInABodyAtRest) {
  const Ordered all = in_order_at_rest();
  const PieceParts parts = piece_parts(all.body, all.id, block);
  expect_division(parts, all.id.size());
  EXPECT_EQ(parts.size(), (all.id.size() + size - 1) / size + 1);  // the middle piece has two
  for (std::size_t part = 0; part < parts.size(); ++part)
    for (std::size_t k = parts.first[part]; k < parts.first[part + 1]; ++k)
      ASSERT_EQ(all.bone(k), all.bone(parts.first[part])) << k;
}

TEST(PieceParts, AreOfOneGroupOrOfOneBoneAndNone) {
  if (!groups_are_built()) GTEST_SKIP() << "built without groups";
  const Points rest = test::fcc_box(11, 11, 49, r);
  Body body = test::make_body(test::box_scene(49), rest);
  const double middle = bounds(rest).center().z();
  std::vector<std::int32_t> group;
  for (const Vec3& X : rest)
    group.push_back(std::abs(X.z() - middle) < 10 * r ? -1 : X.z() < middle ? 0 : 1);
  body.grouping = std::make_shared<const Grouping>(make_grouping(body, group));
  const Ordered all = in_order_at_rest(std::move(body));
  const PieceParts parts = piece_parts(all.body, all.id, block);
  expect_division(parts, all.id.size());
  const auto leader = [&](std::size_t k) {
    const std::int32_t own = all.body.grouping->group[static_cast<std::size_t>(all.id[k])];
    return std::pair(own, own < 0 ? all.bone(k) : 0);
  };
  std::set<std::pair<std::int32_t, int>> leaders;
  for (std::size_t part = 0; part < parts.size(); ++part) {
    const auto most = leader((parts.first[part] + parts.first[part + 1]) / 2);
    leaders.insert(most);
    int others = 0;
    for (std::size_t k = parts.first[part]; k < parts.first[part + 1]; ++k)
      if (leader(k) != most) ++others;
    EXPECT_LT(others, 8) << part;  // a few at either end
  }
  EXPECT_EQ(leaders.size(), 4u);
}

TEST(PieceParts, ArePiecesWhereBonesAlternate) {
  Ordered all = in_order_at_rest();
  std::shuffle(all.id.begin(), all.id.end(), std::mt19937(3));
  const PieceParts parts = piece_parts(all.body, all.id, block);
  expect_division(parts, all.id.size());
  EXPECT_EQ(parts.size(), parts.of_piece.size() - 1);
}

TEST(PieceParts, OfFewParticlesIsOne) {
  Ordered all = in_order_at_rest();
  all.id.resize(5);
  const PieceParts parts = piece_parts(all.body, all.id, block);
  expect_division(parts, 5);
  EXPECT_EQ(parts.size(), 1u);
}

}  // namespace sinew::piece_parts_test

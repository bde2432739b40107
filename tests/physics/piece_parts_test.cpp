// SPDX-License-Identifier: GPL-3.0-or-later
// Parts divide the pieces at the bones, whatever the order of the particles.
#include <sinew/physics/lists/piece_parts.h>

#include <numeric>

#include <sinew/physics/kernel/kernel.h>
#include <sinew/physics/lists/particle_order.h>

#include "all_steppers.h"

namespace sinew::piece_parts_test {

constexpr double r = 0.01;
constexpr std::size_t block = 16, size = block * kernel::blocks_per_piece;

struct Ordered {
  Body body;
  std::vector<std::int32_t> id;

  int bone(std::size_t k) const { return body.binding.bone(static_cast<std::size_t>(id[k])); }
};

Ordered in_order_at_rest() {
  const Points rest = test::fcc_box(11, 11, 49, r);
  Ordered all{test::make_body(test::box_scene(49), rest), {}};
  std::vector<std::int32_t> given(rest.size());
  std::iota(given.begin(), given.end(), 0);
  for (const std::uint32_t place : order_at_rest(all.body, given)) all.id.push_back(given[place]);
  return all;
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

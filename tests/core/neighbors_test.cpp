// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <sinew/core/cell_grid.h>
#include <sinew/core/parallel.h>

#include "support/world.h"

namespace sinew::neighbors_test {

Points cloud(std::size_t count) {
  std::mt19937 random(3);
  Points points(count);
  for (Vec3& point : points) point = test::random_vector(random);
  return points;
}

TEST(NeighborsWithin, AreThoseOfBruteForceInSeveralPieces) {
  const Points points = cloud(9000);
  const double range = 0.06;
  const NeighborLists lists = neighbors_within(points, range);
  ASSERT_EQ(lists.size(), points.size());
  for (std::size_t i = 0; i < points.size(); i += 7) {
    std::vector<std::uint32_t> expected;
    for (std::uint32_t j = 0; j < points.size(); ++j)
      if (j != i && (points[j] - points[i]).squaredNorm() < range * range) expected.push_back(j);
    const auto found = lists.of(i);
    ASSERT_EQ(std::vector<std::uint32_t>(found.begin(), found.end()), expected) << i;
  }
}

TEST(NeighborsWithin, OfNothingAndOfOneAreEmpty) {
  EXPECT_EQ(neighbors_within({}, 1).size(), 0u);
  EXPECT_EQ(neighbors_within({Vec3(1, 2, 3)}, 1).of(0).size(), 0u);
}

TEST(NeighborsWithin, AreTheSameForEveryThreadCount) {
  const Points points = cloud(9000);
  const NeighborLists expected = neighbors_within(points, 0.06);
  for (const int threads : {1, 2, 3, 8})
    with_threads(threads, [&] {
      const NeighborLists found = neighbors_within(points, 0.06);
      EXPECT_EQ(found.first, expected.first);
      EXPECT_EQ(found.neighbor, expected.neighbor);
    });
}

}  // namespace sinew::neighbors_test

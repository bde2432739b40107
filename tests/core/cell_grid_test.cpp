// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/cell_grid.h>

#include <gtest/gtest.h>
#include <algorithm>
#include <random>

namespace sinew::cell_grid_test {

Points cloud(std::size_t count, const Vec3& size, unsigned seed = 1, const Vec3& at = {0, 0, 0}) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  Points points(count);
  for (Vec3& point : points)
    for (int axis = 0; axis < 3; ++axis) point[axis] = at[axis] + size[axis] * unit(random);
  return points;
}

std::vector<std::uint32_t> brute_force(const Points& points, const Vec3& p, double range) {
  std::vector<std::uint32_t> near;
  for (std::uint32_t j = 0; j < points.size(); ++j)
    if ((points[j] - p).squaredNorm() < range * range) near.push_back(j);
  return near;
}

/// The points the grid finds within the range; each may be visited once only.
std::vector<std::uint32_t> by_grid(const CellGrid& grid, const Points& points, const Vec3& p,
                                   double range) {
  std::vector<std::uint32_t> visited, near;
  grid.for_each_near(p, [&](std::uint32_t j) { visited.push_back(j); });
  std::sort(visited.begin(), visited.end());
  EXPECT_EQ(std::adjacent_find(visited.begin(), visited.end()), visited.end()) << "visited twice";
  for (const auto j : visited)
    if ((points[j] - p).squaredNorm() < range * range) near.push_back(j);
  return near;
}

void expect_brute_force(const Points& points, double range) {
  const CellGrid grid(points, range);
  const NeighborLists lists = neighbors_within(points, range);
  ASSERT_EQ(lists.size(), points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    std::vector<std::uint32_t> expected = brute_force(points, points[i], range);
    ASSERT_EQ(by_grid(grid, points, points[i], range), expected) << "point " << i;
    std::erase(expected, i);
    const auto row = lists.of(i);
    ASSERT_EQ(std::vector<std::uint32_t>(row.begin(), row.end()), expected) << "point " << i;
  }
}

TEST(CellGrid, FindsWhatBruteForceFindsInRandomClouds) {
  expect_brute_force(cloud(800, {1, 1, 1}), 0.13);
  expect_brute_force(cloud(500, {5, 0.3, 0.02}), 0.11);
  expect_brute_force(cloud(400, {1, 1, 1}, 2, {-3e4, 2e5, 7}), 0.2);
  expect_brute_force(cloud(300, {1, 1, 1}, 3), 4.0);
  expect_brute_force(cloud(300, {0, 0, 1}, 4), 0.05);
}

TEST(CellGrid, FindsWhatBruteForceFindsInClusters) {
  Points points = cloud(300, {0.01, 0.01, 0.01}, 5);
  for (const Vec3& point : cloud(300, {0.01, 0.01, 0.01}, 6, {4, -2, 1})) points.push_back(point);
  expect_brute_force(points, 0.004);
  expect_brute_force(points, 0.1);
}

TEST(CellGrid, SurvivesParticlesFarAway) {
  Points points = cloud(300, {1, 1, 1}, 7);
  points.emplace_back(1e9, -1e9, 1e9);
  points.emplace_back(-1e12, 0, 0);
  expect_brute_force(points, 0.2);
  points.emplace_back(1e150, 1e150, -1e150);
  expect_brute_force(points, 0.2);
}

TEST(CellGrid, TakesNoPointsOnePointAndManyInOnePlace) {
  expect_brute_force({}, 0.1);
  expect_brute_force({Vec3(1, 2, 3)}, 0.1);
  expect_brute_force(Points(50, Vec3(1, 2, 3)), 0.1);
  int visited = 0;
  CellGrid(Points{}, 0.1).for_each_near({0, 0, 0}, [&](std::uint32_t) { ++visited; });
  EXPECT_EQ(visited, 0);
}

TEST(CellGrid, AnswersForPlacesWhereNoPointIs) {
  const double range = 0.15;
  const Points points = cloud(500, {1, 1, 1}, 8);
  const CellGrid grid(points, range);
  for (const Vec3& p : cloud(400, {2, 2, 2}, 9, {-0.5, -0.5, -0.5}))
    ASSERT_EQ(by_grid(grid, points, p, range), brute_force(points, p, range));
  for (const Vec3& p : {Vec3(1e12, 0, 0), Vec3(-1e300, 1e300, 5), Vec3(0.5, 0.5, -1e18)})
    EXPECT_TRUE(by_grid(grid, points, p, range).empty());
}

TEST(CellGrid, LosesNoPairWhoseDistanceIsJustBelowTheRange) {
  std::mt19937 random(10);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int trial = 0; trial < 200; ++trial) {
    const double range = 0.01 + unit(random), step = range * (1 - 1e-15 * (trial % 8));
    const double start = unit(random);
    Points chain;
    for (int i = 0; i < 100; ++i) chain.emplace_back(start + i * step, 0, 0);
    expect_brute_force(chain, range);
    if (HasFatalFailure()) return;
  }
}

TEST(CellGrid, OnlyVisitsPointsOfTheCellsAround) {
  const Points points = cloud(1000, {1, 1, 1}, 11);
  const double range = 0.1;
  for (const Vec3& p : points)
    CellGrid(points, range).for_each_near(p, [&](std::uint32_t j) {
      ASSERT_LT((points[j] - p).cwiseAbs().maxCoeff(), 2 * range * (1 + 1e-6));
    });
}

TEST(Neighbors, AreMutual) {
  const NeighborLists lists = neighbors_within(cloud(600, {1, 1, 1}, 12), 0.2);
  for (std::uint32_t i = 0; i < lists.size(); ++i)
    for (const auto j : lists.of(i)) {
      const auto back = lists.of(j);
      ASSERT_TRUE(std::binary_search(back.begin(), back.end(), i));
    }
}

TEST(Neighbors, AreNeverCapped) {
  const NeighborLists lists = neighbors_within(Points(2000, Vec3(1, 1, 1)), 0.5);
  for (std::uint32_t i = 0; i < lists.size(); ++i) ASSERT_EQ(lists.of(i).size(), 1999u);
}

}  // namespace sinew::cell_grid_test

// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/mesh/detail/triangulate.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <sinew/core/error.h>

namespace sinew::triangulate_test {

double area_of(const std::vector<std::array<int, 3>>& triangles, const Points& points) {
  double sum = 0;
  for (const auto& [a, b, c] : triangles)
    sum += (points[b] - points[a]).cross(points[c] - points[a]).z() / 2;
  return sum;
}

TEST(Triangulate, CutsConvexPolygonsOfManyCornersInOneGo) {
  constexpr int corners = 200'000;
  Points points;
  std::vector<int> polygon;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * pi * i / corners;
    points.emplace_back(std::cos(angle), std::sin(angle), 0);
    polygon.push_back(i);
  }
  const auto triangles = triangulate(polygon, points);
  EXPECT_EQ(triangles.size(), polygon.size() - 2);
  EXPECT_NEAR(area_of(triangles, points), corners / 2.0 * std::sin(2 * pi / corners), 1e-9);
  std::vector<int> uses(corners);  // triangles of one corner are all near each other
  for (const auto& triangle : triangles)
    for (const int corner : triangle) ++uses[corner];
  EXPECT_LE(*std::max_element(uses.begin(), uses.end()), 2 * std::log2(corners));
}

TEST(Triangulate, CutsAnLWithoutLeavingIt) {
  const Points points = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
  for (int first = 0; first < 6; ++first) {
    std::vector<int> polygon;
    for (int i = 0; i < 6; ++i) polygon.push_back((first + i) % 6);
    const auto triangles = triangulate(polygon, points);
    EXPECT_EQ(triangles.size(), 4u);
    EXPECT_DOUBLE_EQ(area_of(triangles, points), 3);
    for (const auto& triangle : triangles) EXPECT_GE(area_of({triangle}, points), 0);
  }
}

TEST(Triangulate, MakesNoTriangleWithoutAreaOfACornerOnASide) {
  const Points points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
  for (const auto& triangle : triangulate({0, 1, 2, 3, 4}, points))
    EXPECT_GT(area_of({triangle}, points), 0.1);
}

TEST(Triangulate, TakesConvexPolygonsOfAnySizeAndRefusesHugeOthers) {
  Points points;
  std::vector<int> polygon;
  for (int i = 0; i < 3000; ++i) {
    points.emplace_back(std::cos(2 * pi * i / 3000), std::sin(2 * pi * i / 3000), 0);
    polygon.push_back(i);
  }
  EXPECT_NEAR(area_of(triangulate(polygon, points), points), pi, 1e-5);
  points[7] *= 0.5;
  EXPECT_THROW(triangulate(polygon, points), Error);
}

}  // namespace sinew::triangulate_test

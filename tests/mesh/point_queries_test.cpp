// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/mesh/point_queries.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include <sinew/repair/read_surface.h>
#include "mesh/shapes.h"

namespace sinew::point_queries_test {

Points random_points(std::size_t count, double half) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> number(-half, half);
  Points points(count);
  for (Vec3& point : points) point = {number(random), number(random), number(random)};
  return points;
}

bool in_box(const Vec3& point) { return point.cwiseAbs().maxCoeff() < 1; }

TEST(PointQueries, WindAClosedSurfaceOnceAboutItsInside) {
  const Surface box = prepare(shapes::box({-1, -1, -1}, {1, 1, 1}), BodyOptions());
  const Points points = random_points(1000, 2);
  const std::vector<double> winding = winding_numbers(box, points);
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_EQ(winding[i], in_box(points[i]) ? 1 : 0) << points[i].transpose();
  EXPECT_TRUE(std::isnan(winding_numbers(box, {{1, 0.2, 0.3}})[0]));
}

TEST(PointQueries, LeaveTheSolidAngleOfAHoleOut) {
  PolygonSoup open = shapes::box({-1, -1, -1}, {1, 1, 1});
  const Vec3 up(0, 0, 1);
  std::erase_if(open.polygons, [&](const std::vector<int>& face) {
    return std::all_of(face.begin(), face.end(),
                       [&](int corner) { return open.points[corner].dot(up) > 0.5; });
  });
  const Surface surface = prepare(open, BodyOptions());
  for (const double height : {-0.9, 0.0, 0.5, 1.0, 1.5, 4.0}) {
    // The solid angle of a square of side 2 from a point over its center.
    const double away = std::abs(1 - height);
    const double hole = 4 * std::asin(1 / (1 + away * away));
    const double expected = height <= 1 ? 1 - hole / (4 * pi) : hole / (4 * pi);
    EXPECT_NEAR(winding_numbers(surface, {{0, 0, height}})[0], expected, 1e-12) << height;
  }
}

TEST(PointQueries, MeasureTheDistanceOfABox) {
  const Surface box = prepare(shapes::box({-1, -1, -1}, {1, 1, 1}), BodyOptions());
  const Points points = random_points(1000, 2);
  const std::vector<double> away = distances(box.triangles, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 beyond = points[i].cwiseAbs() - Vec3::Ones();
    const double expected = beyond.cwiseMax(0).norm() - std::min(0.0, beyond.maxCoeff());
    EXPECT_NEAR(away[i], expected, 1e-12);
  }
}

}  // namespace sinew::point_queries_test

// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/mesh/surface_distance.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include <sinew/repair/read_surface.h>
#include "mesh/shapes.h"
#include "support/expect_error.h"

namespace sinew::surface_distance_test {

Surface box_of(const Vec3& low, const Vec3& high) {
  return prepare(shapes::box(low, high), BodyOptions());
}

/// Returns the exact distance to a box about the origin.
double distance_to_box(const Vec3& half, const Vec3& p) {
  const Vec3 beyond = p.cwiseAbs() - half;
  return beyond.cwiseMax(0).norm() + std::min(0.0, beyond.maxCoeff());
}

TEST(SurfaceDistance, IsThatOfABoxInsideAndOutside) {
  const Vec3 half(0.5, 1, 2);
  const SurfaceDistance distance(box_of(-half, half));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-2.5, 2.5);
  int inside = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p(number(random), number(random), number(random));
    const NearestPlace nearest = distance.from(p);
    ASSERT_NEAR(nearest.distance, distance_to_box(half, p), 1e-12) << p.transpose();
    EXPECT_NEAR(nearest.normal.norm(), 1, 1e-12);
    const Vec3 on = p - nearest.distance * nearest.normal;
    EXPECT_NEAR(distance_to_box(half, on), 0, 1e-12);
    inside += nearest.distance < 0;
  }
  EXPECT_GT(inside, 50);
}

TEST(SurfaceDistance, HasAFacesNormalOnTheSurface) {
  const SurfaceDistance distance(box_of({-1, -1, -1}, {1, 1, 1}));
  const NearestPlace nearest = distance.from({1, 0.2, 0.3});
  EXPECT_NEAR(nearest.distance, 0, 1e-12);
  EXPECT_EQ(nearest.normal, Vec3(1, 0, 0));
}

TEST(SurfaceDistance, MayBeAskedFromManyThreads) {
  const SurfaceDistance distance(box_of({-1, -1, -1}, {1, 1, 1}));
  std::vector<double> found(8);
  std::vector<std::thread> threads;
  for (int t = 0; t < 8; ++t)
    threads.emplace_back([&, t] {
      for (int i = 0; i < 500; ++i) found[t] += distance.from({0.001 * i, 0.3, 0.2}).distance;
    });
  for (std::thread& thread : threads) thread.join();
  for (const double sum : found) EXPECT_EQ(sum, found[0]);
}

TEST(SurfaceDistance, RefusesHoles) {
  PolygonSoup open = shapes::box({0, 0, 0}, {1, 1, 1});
  open.polygons.pop_back();
  const Surface surface = prepare(open, BodyOptions());
  test::expect_bad_input([&] { SurfaceDistance distance(surface); }, {"not closed (holes: 1)"});
}

}  // namespace sinew::surface_distance_test

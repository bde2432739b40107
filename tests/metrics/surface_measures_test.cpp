// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/detail/surface_distortion.h>

#include <gtest/gtest.h>

#include "metrics/world.h"

namespace sinew::test::surface_measures_test {

TEST(SurfaceDistortion, AStretchedSheetHasItsStretches) {
  const Triangles flat = sheet(3);
  const Mat3 turn = turned(50, {1, 1, 2});
  const SurfaceDistortion d =
      surface_distortion(flat, mapped(flat.points, [&](const Vec3& p) -> Vec3 {
                           return turn * Vec3(2 * p.x(), 0.5 * p.y(), 0) + Vec3(1, 2, 3);
                         }));
  EXPECT_NEAR(d.area, 9, 1e-12);
  EXPECT_NEAR(d.edge_stretch, 2, 1e-12);
  EXPECT_NEAR(d.area_stretch, 1, 1e-12);
  EXPECT_NEAR(d.conformal, 4, 1e-12);
  EXPECT_NEAR(d.dirichlet, 2 * (4 + 0.25), 1e-12);
  EXPECT_EQ(d.flipped, 0);
}

TEST(SurfaceDistortion, AScaledSheetKeepsItsAngles) {
  const Triangles flat = sheet(3);
  const SurfaceDistortion d =
      surface_distortion(flat, mapped(flat.points, [](const Vec3& p) -> Vec3 { return p / 2; }));
  EXPECT_NEAR(d.area_stretch, 4, 1e-12);
  EXPECT_NEAR(d.conformal, 1, 1e-12);
  EXPECT_NEAR(d.dirichlet, 0.25 + 0.25 + 4 + 4, 1e-12);
}

TEST(SurfaceDistortion, CountsTheFacesThatAPointTurnsOver) {
  const Triangles flat = sheet(6);
  Points now = flat.points;
  now[7 * 3 + 3] += Vec3(1.4, 0.2, 0);  // past its neighbor in the plane
  int turned_over = 0;
  for (const auto& face : flat.faces) {
    const Vec3 a = now[face[0]], b_ = now[face[1]], c = now[face[2]];
    turned_over += (b_ - a).cross(c - a).z() < 0;
  }
  EXPECT_GT(turned_over, 0);
  EXPECT_EQ(surface_distortion(flat, now).flipped, turned_over);
}

TEST(SurfaceDistortion, AFaceWithoutAreaAtRestDoesNotCount) {
  Triangles flat = sheet(2);
  flat.faces.push_back({0, 1, 2});  // three points in one line
  const SurfaceDistortion d = surface_distortion(flat, flat.points);
  EXPECT_NEAR(d.conformal, 1, 1e-12);
  EXPECT_NEAR(d.dirichlet, 4, 1e-12);
}

TEST(SurfaceDistortion, AnEdgeWithoutLengthAtRestDoesNotCount) {
  Triangles flat = sheet(2);
  flat.points.push_back(flat.points[4]);
  flat.faces.push_back({4, 5, 9});
  Points now = flat.points;
  now[9] += Vec3(0.1, 0, 0);
  EXPECT_LT(surface_distortion(flat, now).edge_stretch, 1.2);
}

}  // namespace sinew::test::surface_measures_test

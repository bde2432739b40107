// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/mesh/surface_gap.h>

#include <gtest/gtest.h>

#include <cmath>

#include <sinew/core/parallel.h>
#include <sinew/repair/read_surface.h>
#include "mesh/shapes.h"
#include "support/expect_error.h"

namespace sinew::surface_gap_test {

Triangles surface_of(const PolygonSoup& soup) { return prepare(soup, BodyOptions()).triangles; }

Triangles moved(Triangles surface, const Vec3& way) {
  for (Vec3& point : surface.points) point += way;
  return surface;
}

TEST(SurfaceGap, OfASurfaceAndItselfIsNothing) {
  const Triangles ball = surface_of(shapes::sphere(1, 3));
  const SurfaceGap gap = surface_gap(ball, ball);
  EXPECT_NEAR(gap.hausdorff, 0, 1e-12);
  EXPECT_NEAR(gap.mean, 0, 1e-12);
}

TEST(SurfaceGap, OfTwoFacesOverEachOtherIsTheirDistance) {
  const Triangles face{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  const SurfaceGap gap = surface_gap(face, moved(face, {0, 0, 0.25}));
  EXPECT_NEAR(gap.hausdorff, 0.25, 1e-12);
  EXPECT_NEAR(gap.mean, 0.25, 1e-12);
}

TEST(SurfaceGap, OfABoxInABoxIsThatOfTheirCorners) {
  const SurfaceGap gap = surface_gap(surface_of(shapes::box({-1, -1, -1}, {1, 1, 1})),
                                     surface_of(shapes::box({-1.5, -1.5, -1.5}, {1.5, 1.5, 1.5})));
  EXPECT_NEAR(gap.hausdorff, 0.5 * std::sqrt(3.0), 1e-12);  // corner to corner
}

TEST(SurfaceGap, OfConcentricSpheresIsTheDifferenceOfTheirRadii) {
  const Triangles one = surface_of(shapes::sphere(1, 5)),
                  other = surface_of(shapes::sphere(1.2, 5));
  const SurfaceGap gap = surface_gap(one, other);
  EXPECT_NEAR(gap.hausdorff, 0.2, 1e-3);  // they are polyhedra
  EXPECT_NEAR(gap.mean, 0.2, 1e-3);
}

TEST(SurfaceGap, OfDistantBallsIsTheDistanceOfTheirCenters) {
  const Triangles ball = surface_of(shapes::sphere(1, 5));
  const Triangles coarse = moved(surface_of(shapes::sphere(1, 4)), {7, 0, 0});
  for (const Triangles& other : {moved(ball, {7, 0, 0}), coarse})
    EXPECT_NEAR(surface_gap(ball, other).hausdorff, 7, 5e-3);  // they are polyhedra
}

TEST(SurfaceGap, SeesABumpWhicheverSurfaceHasIt) {
  const Triangles plain = surface_of(shapes::sphere(1, 3));
  Triangles bumped = plain;
  bumped.points[0] *= 1.3;
  for (const SurfaceGap& gap : {surface_gap(plain, bumped), surface_gap(bumped, plain)})
    EXPECT_NEAR(gap.hausdorff, 0.3, 1e-12);
}

TEST(SurfaceGap, IsTheSameEitherWayAndForAnyNumberOfThreads) {
  const Triangles one = surface_of(shapes::torus(1, 0.3)),
                  other = moved(surface_of(shapes::torus(1, 0.3, 31, 17)), {0.05, 0.02, -0.1});
  const SurfaceGap gap = surface_gap(one, other), back = surface_gap(other, one);
  EXPECT_EQ(gap.hausdorff, back.hausdorff);
  EXPECT_NEAR(gap.mean, back.mean, 1e-15);
  for (const int threads : {1, 2, 3})
    with_threads(threads, [&] { EXPECT_EQ(surface_gap(one, other).mean, gap.mean); });
}

TEST(SurfaceGap, RefusesWhatHasNoArea) {
  const Triangles ball = surface_of(shapes::sphere(1, 1));
  EXPECT_THROW(surface_gap(ball, {}), Error);
}

}  // namespace sinew::surface_gap_test

// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/volume/implicit_surface.h>

#include <gtest/gtest.h>

#include <cmath>

#include <sinew/core/parallel.h>
#include <sinew/mesh/clean.h>

namespace sinew::implicit_surface_test {

Surface surface_of(const Triangles& skin) {
  PolygonSoup soup{skin.points, {}};
  for (const auto& face : skin.faces) soup.polygons.emplace_back(face.begin(), face.end());
  return clean(soup);
}

double of_ball(const Vec3& p) { return p.norm() - 1; }
double of_torus(const Vec3& p) { return std::hypot(std::hypot(p.x(), p.y()) - 1, p.z()) - 0.3; }

const Box around(Vec3(-1.4, -1.3, -1.5), Vec3(1.4, 1.3, 1.1));

TEST(ImplicitSurface, OfABallIsClosedAndOutwardAndLiesOnIt) {
  const Triangles ball = implicit_surface(of_ball, around, 0.1);
  EXPECT_TRUE(surface_of(ball).closed());
  EXPECT_NEAR(volume(ball), 4 * pi / 3, 0.015);  // flat faces lack h^2 / 8 and more
  EXPECT_NEAR(area(ball), 4 * pi, 0.04);
  for (const Vec3& point : ball.points) EXPECT_NEAR(point.norm(), 1, 1e-8);
}

TEST(ImplicitSurface, ConvergesQuadratically) {
  const double exact = 2 * pi * pi * 0.09;
  double errors[2];
  for (int k = 0; k < 2; ++k)
    errors[k] = exact - volume(implicit_surface(of_torus, around, 0.08 / (k + 1)));
  EXPECT_NEAR(errors[0] / errors[1], 4, 0.6);
}

TEST(ImplicitSurface, EndsAtTheBoxAndIsEmptyWhereNothingIs) {
  EXPECT_TRUE(implicit_surface([](const Vec3&) { return 1.0; }, around, 0.2).faces.empty());
  EXPECT_TRUE(implicit_surface(of_ball, Box(Vec3(5, 5, 5), Vec3(6, 6, 6)), 0.2).faces.empty());
}

TEST(ImplicitSurface, IsTheSameOnAnyNumberOfThreads) {
  const Triangles once = implicit_surface(of_torus, around, 0.1);
  with_threads(1, [&] {
    const Triangles again = implicit_surface(of_torus, around, 0.1);
    EXPECT_EQ(once.points, again.points);
    EXPECT_EQ(once.faces, again.faces);
  });
}

}  // namespace sinew::implicit_surface_test

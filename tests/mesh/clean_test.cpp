// SPDX-License-Identifier: GPL-3.0-or-later
// What cleaning drops, merges and counts. Directions: orient_test.cpp; holes: border_test.cpp.
#include <sinew/mesh/clean.h>

#include <gtest/gtest.h>

#include "mesh/shapes.h"
#include "support/expect_error.h"

namespace sinew::clean_test {

PolygonSoup unit_box() { return shapes::box(Vec3::Zero(), Vec3::Ones()); }

TEST(Clean, KeepsTheOrderOfPointsAndFaces) {
  const auto body = shapes::sphere(1, 2);
  const Surface surface = clean(body);
  EXPECT_EQ(surface.triangles.points, body.points);
  for (std::size_t i = 0; i < body.polygons.size(); ++i)
    EXPECT_TRUE(std::equal(body.polygons[i].begin(), body.polygons[i].end(),
                           surface.triangles.faces[i].begin()));
}

TEST(Clean, CountsNothingOnAMeshWithoutDefects) {
  const Surface surface = clean(shapes::sphere(1, 2));
  const CleaningCounts& counts = surface.cleaning;
  EXPECT_EQ(counts.points_read, 66u);
  EXPECT_EQ(counts.polygons_read, 128u);
  EXPECT_EQ(counts.polygons_cut + counts.points_merged + counts.points_unused +
                counts.faces_collapsed + counts.faces_doubled + counts.faces_flat +
                counts.faces_turned + counts.edges_twisted,
            0u);
  EXPECT_TRUE(surface.closed());
  EXPECT_EQ(surface.components, 1);
  EXPECT_EQ(surface.border.holes + surface.border.edges + surface.border.crowded_edges, 0u);
}

TEST(Clean, CutsQuadsIntoTriangles) {
  const Surface surface = clean(unit_box());
  EXPECT_EQ(surface.triangles.faces.size(), 12u);
  EXPECT_EQ(surface.cleaning.polygons_cut, 6u);
  EXPECT_DOUBLE_EQ(volume(surface.triangles), 1);
}

TEST(Clean, MergesEqualPointsOfATriangleSoup) {
  const auto body = shapes::sphere(1, 2);
  const Surface surface = clean(shapes::burst(body));
  EXPECT_EQ(surface.triangles.points.size(), body.points.size());
  EXPECT_EQ(surface.cleaning.points_merged, 3 * body.polygons.size() - body.points.size());
  EXPECT_TRUE(surface.closed());
  EXPECT_DOUBLE_EQ(volume(surface.triangles), volume(clean(body).triangles));
}

TEST(Clean, TakesMinusZeroForZero) {
  auto soup = shapes::tetrahedron();
  soup.points.emplace_back(-0.0, -0.0, 1);
  soup.polygons[3][2] = 4;
  EXPECT_EQ(clean(soup).cleaning.points_merged, 1u);
}

TEST(Clean, DropsCollapsedAndDoubledFacesAndUnusedPoints) {
  auto soup = shapes::tetrahedron();
  soup.points.emplace_back(9, 9, 9);
  soup.polygons.push_back({0, 1, 1});
  soup.polygons.push_back({1, 2, 0});  // one of the faces, in its direction
  soup.polygons.push_back({0, 1, 2});  // and against it
  const Surface surface = clean(soup);
  EXPECT_EQ(surface.triangles.faces.size(), 4u);
  EXPECT_EQ(surface.cleaning.faces_collapsed, 1u);
  EXPECT_EQ(surface.cleaning.faces_doubled, 2u);
  EXPECT_EQ(surface.cleaning.points_unused, 1u);
  EXPECT_TRUE(surface.closed());
}

TEST(Clean, OfDoubledFacesKeepsTheFirst) {
  const auto body = shapes::sphere(1, 2);
  auto doubled = body;
  for (const auto& polygon : shapes::inverted(body).polygons) doubled.polygons.push_back(polygon);
  const Surface surface = clean(doubled);
  EXPECT_EQ(surface.cleaning.faces_doubled, body.polygons.size());
  EXPECT_EQ(surface.cleaning.faces_turned, 0u);
  EXPECT_EQ(surface.triangles.faces, clean(body).triangles.faces);
}

TEST(Clean, KeepsAFaceWithoutAreaThatClosesTheSurface) {
  auto soup = shapes::tetrahedron();  // the edge 0-1 of one face gets a point in its middle
  soup.points.emplace_back(0.5, 0, 0);
  soup.polygons[1] = {0, 4, 3};
  soup.polygons.push_back({4, 1, 3});
  soup.polygons.push_back({0, 1, 4});
  const Surface surface = clean(soup);
  EXPECT_EQ(surface.cleaning.faces_flat, 1u);
  EXPECT_TRUE(surface.closed());
  EXPECT_DOUBLE_EQ(volume(surface.triangles), 1.0 / 6);
}

TEST(Clean, CountsFlatFacesExactly) {
  PolygonSoup soup{{{0, 0, 0}, {1, 3, 7}, {3, 9, 21}, {1.0 / 3, 1, 7.0 / 3 + 1e-15}},
                   {{0, 1, 2}, {0, 1, 3}, {1, 2, 3}}};
  EXPECT_EQ(clean(soup).cleaning.faces_flat, 1u);
}

TEST(Weld, ClosesTheGapsOfATornMesh) {
  const auto body = shapes::sphere(1, 3);
  auto torn = shapes::burst(body);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> shift(-1e-6, 1e-6);
  for (Vec3& point : torn.points) point += Vec3(shift(random), shift(random), shift(random));
  EXPECT_EQ(clean(torn).border.holes, body.polygons.size());
  const Surface surface = clean(torn, {.weld = 1e-5});
  EXPECT_TRUE(surface.closed());
  EXPECT_EQ(surface.triangles.points.size(), body.points.size());
  EXPECT_EQ(surface.cleaning.points_merged, torn.points.size() - body.points.size());
  EXPECT_NEAR(volume(surface.triangles), volume(clean(body).triangles), 1e-5);
}

TEST(Weld, KeepsPointsApartThatAreFartherAndTheFirstOfEach) {
  const auto body = shapes::burst(shapes::sphere(1, 4));
  for (const double weld : {0.03, 0.1, 0.4}) {
    const Points points = clean(body, {.weld = weld}).triangles.points;
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_NE(std::find(body.points.begin(), body.points.end(), points[i]), body.points.end());
      for (std::size_t j = 0; j < i; ++j) ASSERT_GE((points[i] - points[j]).norm(), weld);
    }
  }
}

TEST(Weld, DoesNotPullAChainOfPointsTogether) {
  PolygonSoup fan{{{0, 1, 0}}, {}};
  for (int i = 0; i <= 100; ++i) fan.points.emplace_back(0.01 * i, 0, 0);
  for (int i = 1; i <= 100; ++i) fan.polygons.push_back({0, i, i + 1});
  const Surface surface = clean(fan, {.weld = 0.015});
  EXPECT_EQ(surface.cleaning.points_merged, 50u);
  EXPECT_EQ(surface.cleaning.faces_collapsed, 50u);
  EXPECT_DOUBLE_EQ(area(surface.triangles), 0.5);
}

TEST(Weld, WorksAtAnySizeAndWithFarOutliers) {
  auto soup = shapes::burst(shapes::sphere(1e-6, 3));
  const std::size_t points = shapes::sphere(1, 3).points.size();
  EXPECT_EQ(clean(soup, {.weld = 1e-12}).triangles.points.size(), points);
  soup = shapes::together(soup, shapes::tetrahedron(1e15));
  EXPECT_EQ(clean(soup, {.weld = 1e-12}).triangles.points.size(), points + 4);
  EXPECT_EQ(clean(soup, {.weld = 1e-320}).triangles.points.size(), points + 4);
}

TEST(Clean, CountsComponentsByAnySharedEdge) {
  const auto body = shapes::sphere(1, 1);
  auto soup = shapes::together(body, shapes::moved(body, Vec3(5, 0, 0)));
  EXPECT_EQ(clean(soup).components, 2);
  const int size = static_cast<int>(body.points.size());
  soup.polygons.push_back({0, 1, size});  // a point alone does not join
  EXPECT_EQ(clean(soup).components, 3);
  soup.polygons.back() = {body.polygons[0][0], body.polygons[0][1], size};
  const Surface surface = clean(soup);
  EXPECT_EQ(surface.components, 2);
  EXPECT_EQ(surface.component.front(), 0);
  EXPECT_EQ(surface.component.back(), 0);
  EXPECT_EQ(surface.component[body.polygons.size()], 1);
}

TEST(Clean, RefusesWhatHoldsNoFaceAndWhatIsTooLarge) {
  const PolygonSoup point{{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, {{0, 1, 2}}};
  test::expect_bad_input([&] { clean(point); }, {"all 1 faces are collapsed", "; "});
  test::expect_bad_input([] { clean(shapes::tetrahedron(), {.weld = 9}); },
                         {"all 4 faces are collapsed", "smaller weld distance"});
  test::expect_bad_input([] { clean(shapes::tetrahedron(1e100)); },
                         {"a coordinate is 1e+100 m from 0", "1e+90 m"});
  EXPECT_DOUBLE_EQ(volume(clean(shapes::tetrahedron(1e60)).triangles), 1e180 / 6);
}

TEST(Clean, TakesAFlatSheet) {
  const Surface surface = clean(shapes::sheet(4));
  EXPECT_EQ(surface.border.holes, 1u);
  EXPECT_EQ(surface.border.edges, 16u);
  EXPECT_DOUBLE_EQ(surface.border.length, 4);
  EXPECT_EQ(surface.cleaning.faces_turned, 0u);
}

}  // namespace sinew::clean_test

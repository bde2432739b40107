// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/repair/diagnosis.h>

#include <gtest/gtest.h>

#include <cmath>

#include <sinew/mesh/clean.h>
#include "mesh/shapes.h"

namespace sinew::diagnosis_test {

using shapes::sphere;
using shapes::together;

SelfIntersections crossings(const PolygonSoup& soup) {
  return self_intersections(clean(soup).triangles);
}

std::size_t faces_in(const std::vector<bool>& flags) {
  return static_cast<std::size_t>(std::count(flags.begin(), flags.end(), true));
}

TEST(SelfIntersections, AreNoneWhereFacesMeetAtTheirCornersAndEdges) {
  auto corner = together(shapes::tetrahedron(), shapes::tetrahedron(-1));
  auto edge =
      together(shapes::box(Vec3::Zero(), Vec3::Ones()), shapes::box(Vec3(1, 1, 0), Vec3(2, 2, 1)));
  for (const auto& soup :
       {sphere(1, 3), shapes::without(sphere(1, 3), 0.2), corner, edge, shapes::sheet(5),
        shapes::moebius_strip(24), shapes::burst(sphere(1, 2), 0.9)}) {
    const SelfIntersections found = crossings(soup);
    EXPECT_EQ(found.pairs, 0u);
    EXPECT_TRUE(found.complete);
  }
}

TEST(SelfIntersections, AreTheFacesWherePartsCutEachOther) {
  const auto a = shapes::tetrahedron(), b = shapes::moved(a, Vec3(0.1, 0.1, 0.1));
  const SelfIntersections found = crossings(together(a, b));
  EXPECT_EQ(found.pairs, 3u);  // three faces of b through the large one of a
  EXPECT_TRUE(found.complete);
  EXPECT_EQ(faces_in(found.faces), 4u);
}

TEST(SelfIntersections, AreFoundInOpenAndCrowdedSurfacesToo) {
  const PolygonSoup cross{{{-1, -1, 0}, {1, -1, 0}, {0, 2, 0}, {0, 0, -1}, {0, 0, 1}, {0, 1, 1}},
                          {{0, 1, 2}, {3, 4, 5}}};
  EXPECT_EQ(crossings(cross).pairs, 1u);
  const PolygonSoup at_a_corner{{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0.5, 0.5, -1}, {0.6, 0.5, 1}},
                                {{0, 1, 2}, {0, 3, 4}}};
  EXPECT_EQ(crossings(at_a_corner).pairs, 1u);
  auto needle = sphere(1, 3);
  needle.points[0] = Vec3(-2, 0, 0);  // its tip pushed through to the other side
  EXPECT_GT(crossings(shapes::without(needle, 0.2)).pairs, 0u);
  const PolygonSoup folded{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.2, 0}},
                           shapes::tetrahedron().polygons};
  EXPECT_GT(crossings(folded).pairs, 0u);
}

TEST(SelfIntersections, EndWhereFacesWithoutAreaHaveTwoPointsInOnePlace) {
  const Triangles surface{{{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                          {{0, 1, 2}, {1, 0, 2}, {0, 2, 3}}};
  EXPECT_EQ(self_intersections(surface).pairs, 0u);
}

TEST(SelfIntersections, StopWhereThereAreTooMany) {
  const auto soup = together(sphere(1, 4), sphere(1, 4, Vec3(0.01, 0.02, 0.03)));
  const SelfIntersections all = crossings(soup),
                          some = self_intersections(clean(soup).triangles, 7);
  EXPECT_GT(all.pairs, 100u);
  EXPECT_TRUE(all.complete);
  EXPECT_EQ(some.pairs, 7u);
  EXPECT_FALSE(some.complete);
}

TEST(SelfIntersections, OfAFanOfNeedlesTakeNoLongerThanTheyMay) {
  const int n = 20000;
  PolygonSoup fan{{{0, 0, 1}}, {}};
  for (int i = 0; i < n; ++i)
    fan.points.emplace_back(std::cos(2 * pi * i / n), std::sin(2 * pi * i / n), 0);
  for (int i = 0; i < n; ++i) fan.polygons.push_back({0, 1 + i, 1 + (i + 1) % n});
  EXPECT_FALSE(crossings(fan).complete);
}

double thinnest(const PolygonSoup& soup) { return diagnose(clean(soup)).thinnest.value_or(-1); }

TEST(Thickness, IsThatOfASphereAPlateAndAShell) {
  EXPECT_NEAR(thinnest(sphere(0.5, 4)), 1, 0.01);
  EXPECT_NEAR(thinnest(shapes::box(Vec3::Zero(), Vec3(1, 2, 0.05))), 0.05, 1e-12);
  EXPECT_NEAR(thinnest(together(sphere(1, 4), shapes::inverted(sphere(0.9, 4)))), 0.1, 0.01);
  EXPECT_NEAR(thinnest(shapes::torus(1, 0.1)), 0.2, 0.01);
}

TEST(Thickness, LooksThroughPartsThatOverlap) {
  // A thin slab between the boxes would be 0.01 by the first face a ray meets.
  const auto soup = together(shapes::box(Vec3::Zero(), Vec3(1, 1, 1)),
                             shapes::box(Vec3(0.99, 0, 0), Vec3(2, 1, 1)));
  EXPECT_GT(thinnest(soup), 0.9);
}

TEST(Thickness, IsFoundWhereASmallPartIsThin) {
  const auto pin = shapes::box(Vec3(0.4, 0.4, 1), Vec3(0.42, 0.42, 3));  // 4 % of the area
  EXPECT_NEAR(thinnest(together(shapes::box(Vec3::Zero(), Vec3(1, 1, 1)), pin)), 0.02, 1e-12);
}

TEST(Thickness, IsNoneWhereThereIsNoInside) {
  EXPECT_FALSE(diagnose(clean(shapes::sheet(8))).thinnest);
  EXPECT_FALSE(diagnose(clean({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}})).thinnest);
  EXPECT_NEAR(thinnest(shapes::without(sphere(1, 4), 0.2)), 2, 0.01);  // holes do not matter
}

Defects defects(const PolygonSoup& soup) {
  const Surface surface = clean(soup);
  return defects_of(surface, diagnose(surface));
}

TEST(Defects, NameTheEdgesOfEachHole) {
  auto body = sphere(1, 3);
  body.polygons.erase(body.polygons.begin() + 100);
  body.polygons.erase(body.polygons.begin());
  const Defects found = defects(shapes::flipped(body, 0.1));
  ASSERT_EQ(found.edges.size(), 6u);
  std::array<int, 2> sides = {};
  for (const DefectiveEdge& edge : found.edges) {
    EXPECT_EQ(edge.defect, EdgeDefect::open);
    ++sides.at(edge.hole);
  }
  EXPECT_EQ(sides, (std::array{3, 3}));
  EXPECT_EQ(faces_in(found.turned), clean(shapes::flipped(body, 0.1)).cleaning.faces_turned);
}

TEST(Defects, NameCrowdedAndTwistedEdges) {
  const Defects boxes = defects(
      together(shapes::box(Vec3::Zero(), Vec3::Ones()), shapes::box(Vec3(1, 1, 0), Vec3(2, 2, 1))));
  ASSERT_EQ(boxes.edges.size(), 1u);
  EXPECT_EQ(boxes.edges[0].defect, EdgeDefect::crowded);
  EXPECT_EQ(boxes.edges[0].hole, -1);
  const Surface strip = clean(shapes::moebius_strip(24));
  std::size_t twisted = 0;
  for (const DefectiveEdge& edge : defects(shapes::moebius_strip(24)).edges)
    twisted += edge.defect == EdgeDefect::twisted && edge.hole >= 0;
  EXPECT_EQ(twisted, strip.cleaning.edges_twisted);
}

TEST(Defects, NameTheFacesThatCutEachOtherAndThoseWithoutArea) {
  const auto a = shapes::tetrahedron();
  auto soup = together(a, shapes::moved(a, Vec3(0.1, 0.1, 0.1)));
  soup.points.emplace_back(0.5, 0, 0);
  soup.polygons.push_back({0, 1, 8});
  const Defects found = defects(soup);
  EXPECT_EQ(faces_in(found.intersecting), 4u);
  EXPECT_EQ(faces_in(found.flat), 1u);
  EXPECT_TRUE(found.flat.back());
}

}  // namespace sinew::diagnosis_test

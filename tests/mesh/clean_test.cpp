// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/clean.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "mesh/shapes.h"
#include "mesh/triangulate.h"

namespace sinew {
namespace {

std::string refusal(const PolygonSoup& soup) {
  try {
    clean(soup);
  } catch (const Error& error) {
    EXPECT_EQ(error.exit(), Exit::bad_input);
    EXPECT_NE(std::string(error.what()).find("; "), std::string::npos);
    return error.what();
  }
  return "none";
}

PolygonSoup unit_box() { return shapes::box(Vec3::Zero(), Vec3::Ones()); }

TEST(Clean, KeepsTheOrderOfPointsAndFaces) {
  const auto body = shapes::sphere(1, 2);
  const Surface surface = clean(body);
  EXPECT_EQ(surface.triangles.points, body.points);
  for (std::size_t i = 0; i < body.polygons.size(); ++i)
    EXPECT_TRUE(std::equal(body.polygons[i].begin(), body.polygons[i].end(),
                           surface.triangles.faces[i].begin()));
}

TEST(Clean, CutsQuadsIntoTriangles) {
  const Surface surface = clean(unit_box());
  EXPECT_EQ(surface.triangles.faces.size(), 12u);
  EXPECT_EQ(surface.cleaning.polygons_cut, 6u);
  EXPECT_DOUBLE_EQ(volume(surface.triangles), 1);
}

TEST(Clean, MergesEqualPointsOfATriangleSoup) {
  const auto body = shapes::sphere(1, 2);
  PolygonSoup soup;
  for (const auto& f : body.polygons) {
    const int first = static_cast<int>(soup.points.size());
    for (const int corner : f) soup.points.push_back(body.points[corner]);
    soup.polygons.push_back({first, first + 1, first + 2});
  }
  const Surface surface = clean(soup);
  EXPECT_EQ(surface.triangles.points.size(), body.points.size());
  EXPECT_EQ(surface.cleaning.points_merged, soup.points.size() - body.points.size());
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
  soup.polygons.push_back({1, 2, 0});
  soup.polygons.push_back({0, 1, 2});
  const Surface surface = clean(soup);
  EXPECT_EQ(surface.triangles.faces.size(), 4u);
  EXPECT_EQ(surface.cleaning.faces_collapsed, 1u);
  EXPECT_EQ(surface.cleaning.faces_doubled, 2u);
  EXPECT_EQ(surface.cleaning.points_unused, 1u);
}

TEST(Clean, TurnsAnyMixtureOfDirectionsOutward) {
  const auto body = shapes::sphere(1, 2);
  for (const int every : {1, 2, 3, 7}) {
    auto mixed = body;
    std::size_t turned = 0;
    for (std::size_t i = 0; i < mixed.polygons.size(); i += every, ++turned)
      std::swap(mixed.polygons[i][0], mixed.polygons[i][1]);
    const Surface surface = clean(mixed);
    EXPECT_DOUBLE_EQ(volume(surface.triangles), volume(clean(body).triangles));
    EXPECT_EQ(surface.cleaning.faces_turned, turned);
  }
}

TEST(Clean, KeepsAFaceWithoutAreaThatClosesTheSurface) {
  auto soup = shapes::tetrahedron();  // the edge 0-1 of one face gets a point in its middle
  soup.points.emplace_back(0.5, 0, 0);
  soup.polygons[1] = {0, 4, 3};
  soup.polygons.push_back({4, 1, 3});
  soup.polygons.push_back({0, 1, 4});
  const Surface surface = clean(soup);
  EXPECT_EQ(surface.cleaning.faces_flat, 1u);
  EXPECT_DOUBLE_EQ(volume(surface.triangles), 1.0 / 6);
}

TEST(Clean, RefusesAnOpenBoxWithItsNumberOfEdges) {
  auto soup = unit_box();
  soup.polygons.pop_back();
  EXPECT_NE(refusal(soup).find("4 edges of 17"), std::string::npos) << refusal(soup);
}

TEST(Clean, RefusesEdgesOfThreeFaces) {
  auto soup = shapes::tetrahedron();
  soup.points.emplace_back(1, 1, 1);
  soup.polygons.push_back({0, 1, 4});
  EXPECT_NE(refusal(soup).find("1 edge of 8 join more than two"), std::string::npos)
      << refusal(soup);
}

TEST(Clean, RefusesAKleinBottle) {
  const int n = 24, m = 12;
  PolygonSoup soup = shapes::wrapped_grid(n, m, [&](int i, int j) {
    const double a = 2 * pi * i / n, b = 2 * pi * j / m;
    const double rho = 2 + std::cos(a / 2) * std::sin(b) - std::sin(a / 2) * std::sin(2 * b);
    return Vec3(rho * std::cos(a), rho * std::sin(a),
                std::sin(a / 2) * std::sin(b) + std::cos(a / 2) * std::sin(2 * b));
  });
  for (int j = 0; j < m; ++j)  // where i closes, j runs the other way
    soup.polygons[(n - 1) * m + j] = {(n - 1) * m + j, (m - j) % m, (2 * m - j - 1) % m,
                                      (n - 1) * m + (j + 1) % m};
  EXPECT_NE(refusal(soup).find("one side only"), std::string::npos) << refusal(soup);
}

TEST(Clean, RefusesPartsThatCutEachOther) {
  const auto other = shapes::moved(shapes::tetrahedron(), Vec3(0.1, 0.1, 0.1));
  const std::string message = refusal(shapes::together(shapes::tetrahedron(), other));
  EXPECT_NE(message.find("pairs of faces cut or touch"), std::string::npos) << message;
}

TEST(Clean, RefusesABodyThatCutsItself) {
  auto soup = shapes::sphere(1, 3);
  soup.points[0] = Vec3(-2, 0, 0);  // its tip pushed through to the other side
  EXPECT_NE(refusal(soup).find("pairs of faces cut"), std::string::npos) << refusal(soup);
}

TEST(Clean, RefusesAFaceFoldedOntoItsNeighbour) {
  PolygonSoup soup{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.2, 0}},
                   shapes::tetrahedron().polygons};
  EXPECT_NE(refusal(soup).find("pairs of faces"), std::string::npos) << refusal(soup);
}

TEST(Clean, AcceptsBodiesThatShareACorner) {
  auto other = shapes::tetrahedron(-1);
  const Surface surface = clean(shapes::together(shapes::tetrahedron(), other));
  EXPECT_EQ(surface.bodies, 2);
  EXPECT_EQ(surface.triangles.points.size(), 7u);
  EXPECT_DOUBLE_EQ(volume(surface.triangles), 2.0 / 6);
}

TEST(Clean, RefusesABodyTooSmallOrLargeForNumbers) {
  EXPECT_NE(refusal(shapes::tetrahedron(1e-200)), "none");
  EXPECT_NE(refusal(shapes::tetrahedron(1e200)), "none");
}

double area_of(const std::vector<std::array<int, 3>>& triangles, const Points& points) {
  double sum = 0;
  for (const auto& [a, b, c] : triangles)
    sum += (points[b] - points[a]).cross(points[c] - points[a]).z() / 2;
  return sum;
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

}  // namespace
}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/mesh/face_tree.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <sinew/mesh/face_queries.h>
#include <sinew/repair/read_surface.h>
#include <sinew/repair/self_intersections.h>
#include "mesh/shapes.h"

namespace sinew::face_tree_test {

Triangles surface_of(const PolygonSoup& soup) { return prepare(soup, BodyOptions()).triangles; }

/// Crumpled by waves of that size (m).
Triangles crumpled(Triangles surface, double size) {
  for (Vec3& p : surface.points)
    p += size * Vec3(std::sin(9 * p.y()), std::cos(7 * p.z()), std::sin(11 * p.x()));
  return surface;
}

Box box_of(const Triangles& surface, std::size_t face) {
  Box box;
  for (const int corner : surface.faces[face]) box.extend(surface.points[corner]);
  return box;
}

TEST(FaceTree, FindsThePlacesThatCgalFindsBitByBit) {
  const Triangles torus = surface_of(shapes::torus(1, 0.3));
  for (const double size : {0.0, 1e-15, 1e-9, 1e-3, 0.3}) {
    const Triangles other = crumpled(torus, size);
    const FaceTree tree(other);
    const NearestFace nearest(other);
    FaceTree::Candidates candidates;
    for (const Vec3& point : torus.points) {
      const Vec3 expected = nearest.to(point).place;
      const double distance = (expected - point).norm();
      EXPECT_NEAR(tree.distance(point, 10), distance, 1e-12);
      if (distance > 1e-12) {
        EXPECT_EQ(tree.distance(point, distance / 2), distance / 2);
      }
      for (const double bound : {distance, 3 * distance + 0.1}) {
        tree.find_near(Box(point), bound, candidates);
        EXPECT_EQ(tree.nearest(point, bound, candidates), expected) << size;
      }
    }
  }
}

TEST(FaceTree, FindsEachPairOfBoxesThatMeetOnce) {
  for (const double size : {0.0, 0.3}) {
    const Triangles surface = crumpled(surface_of(shapes::torus(1, 0.3, 23, 11)), size);
    auto found = FaceTree(surface).meeting_boxes(1'000'000);
    for (auto& pair : found) std::sort(pair.begin(), pair.end());
    std::sort(found.begin(), found.end());
    std::vector<std::array<std::uint32_t, 2>> expected;
    for (std::uint32_t a = 0; a < surface.faces.size(); ++a)
      for (std::uint32_t b = a + 1; b < surface.faces.size(); ++b)
        if (box_of(surface, a).intersects(box_of(surface, b))) expected.push_back({a, b});
    EXPECT_EQ(found, expected);
    EXPECT_GT(FaceTree(surface).meeting_boxes(100).size(), 100u);
  }
}

TEST(FaceTree, LeavesOutFacesWithoutArea) {
  const Triangles surface{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  EXPECT_EQ(FaceTree(surface).faces(), std::vector<std::uint32_t>{1});
  EXPECT_TRUE(FaceTree(surface).meeting_boxes(9).empty());
  EXPECT_TRUE(FaceTree({}).faces().empty());
}

TEST(FaceTree, HasTheSelfIntersectionsOfItsSurface) {
  const Triangles torus = surface_of(shapes::torus(1, 0.3));
  Triangles flat = crumpled(torus, 0.3);
  flat.points[flat.faces[0][1]] = flat.points[flat.faces[0][0]];
  std::size_t pairs = 0;
  for (const Triangles& surface : {torus, crumpled(torus, 0.1), crumpled(torus, 0.3), flat}) {
    const SelfIntersections expected = self_intersections(surface);
    const SelfIntersections found = self_intersections(FaceTree(surface));
    EXPECT_EQ(found.pairs, expected.pairs);
    EXPECT_EQ(found.first, expected.first);
    EXPECT_EQ(found.faces, expected.faces);
    EXPECT_EQ(found.complete, expected.complete);
    pairs += found.pairs;
  }
  EXPECT_GT(pairs, 100u);
}

}  // namespace sinew::face_tree_test

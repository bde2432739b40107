// SPDX-License-Identifier: GPL-3.0-or-later
// Holes and what closes them.
#include <sinew/mesh/border.h>

#include <gtest/gtest.h>

#include <sinew/mesh/clean.h>
#include "mesh/shapes.h"
#include "mesh/surface_laws.h"

namespace sinew::border_test {

using shapes::sphere;
using shapes::together;

TEST(Border, OfABoxWithoutLidIsOneHole) {
  auto box = shapes::box(Vec3::Zero(), Vec3::Ones());
  box.polygons.pop_back();
  const Surface surface = clean(box);
  EXPECT_FALSE(surface.closed());
  EXPECT_EQ(surface.border.holes, 1u);
  EXPECT_EQ(surface.border.edges, 4u);
  EXPECT_DOUBLE_EQ(surface.border.length, 4);
  EXPECT_EQ(surface.border.crowded_edges, 0u);
  EXPECT_EQ(surface.caps.faces.size(), 2u);
  EXPECT_EQ(surface.caps.points.size(), 4u);
  EXPECT_EQ(laws::border_with_caps(surface), 0u);
  EXPECT_DOUBLE_EQ(laws::capped_volume(surface), 1);
}

TEST(Border, OfATriangleGetsATriangle) {
  auto body = shapes::tetrahedron();
  body.polygons.pop_back();
  const Surface surface = clean(body);
  ASSERT_EQ(surface.caps.faces.size(), 1u);
  EXPECT_EQ(surface.caps.points.size(), 3u);
  EXPECT_DOUBLE_EQ(laws::capped_volume(surface), 1.0 / 6);
}

TEST(Border, WithItsCapsIsEmptyWhateverIsMissing) {
  for (const auto& body : {sphere(1, 4), shapes::torus(1, 0.4)})
    for (const double missing : {0.05, 0.2, 0.5, 0.9}) {
      const Surface surface = clean(shapes::flipped(shapes::without(body, missing), 0.1));
      EXPECT_GT(surface.border.holes, 0u);
      EXPECT_EQ(laws::border_with_caps(surface), 0u) << missing;
    }
}

TEST(Border, WithItsCapsIsEmptyForATangle) {
  std::mt19937 random(4);
  PolygonSoup tangle;
  for (int i = 0; i < 30; ++i)
    tangle.points.push_back(Vec3(random(), random(), random()) / 4294967296.0);
  for (int i = 0; i < 400; ++i)
    tangle.polygons.push_back({static_cast<int>(random() % 30), static_cast<int>(random() % 30),
                               static_cast<int>(random() % 30)});
  const Surface surface = clean(tangle);
  EXPECT_GT(surface.border.crowded_edges, 0u);
  EXPECT_EQ(laws::border_with_caps(surface), 0u);
}

TEST(Border, OfSingleMissingFacesHasOneCapEach) {
  auto body = sphere(1, 3);
  for (const std::size_t face : {400, 300, 200, 100, 0})
    body.polygons.erase(body.polygons.begin() + static_cast<std::ptrdiff_t>(face));
  const Surface surface = clean(body);
  EXPECT_EQ(surface.border.holes, 5u);
  EXPECT_EQ(surface.border.edges, 15u);
  EXPECT_EQ(surface.caps.faces.size(), 5u);
  EXPECT_NEAR(laws::capped_volume(surface), volume(clean(sphere(1, 3)).triangles), 1e-12);
}

TEST(Border, MakesTwoHolesOfOneThatTouchesItself) {
  auto body = shapes::sheet(4);
  body.polygons.erase(body.polygons.begin() + 10);  // 2, 2
  body.polygons.erase(body.polygons.begin() + 5);   // 1, 1: they share a corner
  const Surface surface = clean(body);
  EXPECT_EQ(surface.border.holes, 3u);
  EXPECT_EQ(surface.border.edges, 24u);
  EXPECT_EQ(surface.caps.faces.size(), 14u + 2 + 2);
}

TEST(Border, CapsOfAHalfSphereGiveHalfItsVolume) {
  auto body = sphere(1, 5);
  std::erase_if(body.polygons, [&](const std::vector<int>& f) {
    return body.points[f[0]].z() + body.points[f[1]].z() + body.points[f[2]].z() < 0;
  });
  const Surface surface = clean(body);
  EXPECT_EQ(surface.border.holes, 1u);
  EXPECT_NEAR(laws::capped_volume(surface), 2.0 / 3 * pi, 0.01);
  EXPECT_NEAR(surface.border.length, 2 * pi, 0.01);
  Triangles all = surface.triangles;
  for (const Vec3& at : {Vec3(0, 0, 0.5), Vec3(0.3, 0.2, -0.4)})
    EXPECT_NEAR(laws::winding_number(all, at) + laws::winding_number(surface.caps, at),
                at.z() > 0 ? 1 : 0, 1e-9);
}

TEST(Border, OfAnInnerWallIsClosedByItsOwnCap) {
  // Two boxes that have a wall in common, which only one of them has as a face.
  auto soup =
      together(shapes::box(Vec3::Zero(), Vec3::Ones()), shapes::box(Vec3(1, 0, 0), Vec3(2, 1, 1)));
  std::erase_if(soup.polygons, [&](const std::vector<int>& face) {
    return face[0] >= 8 && std::all_of(face.begin(), face.end(),
                                       [&](int point) { return soup.points[point].x() == 1; });
  });
  for (const auto& given : {soup, shapes::inverted(soup)}) {
    const Surface surface = clean(given);
    EXPECT_EQ(surface.border.crowded_edges, 4u);
    EXPECT_EQ(surface.border.holes, 1u);
    EXPECT_EQ(surface.border.edges, 4u);
    EXPECT_EQ(laws::border_with_caps(surface), 0u);
    for (const double x : {0.3, 1.7})
      EXPECT_NEAR(laws::winding_number(surface.triangles, {x, 0.4, 0.6}) +
                      laws::winding_number(surface.caps, {x, 0.4, 0.6}),
                  1, 1e-9);
  }
}

TEST(Loops, AreSimpleAndTakeEveryEdgeOnce) {
  // A figure of eight through 0, and a loop of another group over the same points.
  const std::vector<Loop> loops = simple_loops({{0, 0, 1},
                                                {0, 1, 2},
                                                {0, 2, 0},
                                                {0, 0, 3},
                                                {0, 3, 4},
                                                {0, 4, 0},
                                                {1, 2, 1},
                                                {1, 1, 0},
                                                {1, 0, 2}});
  ASSERT_EQ(loops.size(), 3u);
  EXPECT_EQ(loops[0].points, (std::vector{0, 1, 2}));
  EXPECT_EQ(loops[1].points, (std::vector{0, 3, 4}));
  EXPECT_EQ(loops[2].points, (std::vector{0, 2, 1}));
  EXPECT_EQ(loops[2].group, 1);
}

TEST(Loops, CountEdgesThatStandTwiceTwice) {
  const std::vector<Loop> loops =
      simple_loops({{0, 0, 1}, {0, 0, 1}, {0, 1, 2}, {0, 1, 3}, {0, 2, 0}, {0, 3, 0}});
  ASSERT_EQ(loops.size(), 2u);
  EXPECT_EQ(loops[0].points, (std::vector{0, 1, 2}));
  EXPECT_EQ(loops[1].points, (std::vector{0, 1, 3}));
}

}  // namespace sinew::border_test

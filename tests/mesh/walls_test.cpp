// SPDX-License-Identifier: GPL-3.0-or-later
// Solids that touch: the faces they share part them and bound nothing.
#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include <sinew/mesh/clean.h>
#include <sinew/mesh/surface.h>
#include "mesh/shapes.h"
#include "mesh/surface_laws.h"

namespace sinew::walls_test {

PolygonSoup cell(const Vec3& low) { return shapes::box(low, low + Vec3::Ones()); }

PolygonSoup cells(int nx, int ny, int nz) {
  PolygonSoup soup;
  for (int i = 0; i < nx; ++i)
    for (int j = 0; j < ny; ++j)
      for (int k = 0; k < nz; ++k) soup = shapes::together(soup, cell(Vec3(i, j, k)));
  return soup;
}

/// Faces between neighbors of a block of cells, as pairs of triangles.
std::size_t walls_of(int nx, int ny, int nz) {
  return 2 * ((nx - 1) * ny * nz + nx * (ny - 1) * nz + nx * ny * (nz - 1));
}

void expect_block(const Surface& surface, int nx, int ny, int nz) {
  EXPECT_TRUE(surface.closed());
  EXPECT_EQ(surface.border.crowded_edges, 0u);
  EXPECT_EQ(surface.cleaning.faces_shared, walls_of(nx, ny, nz));
  EXPECT_EQ(surface.cleaning.faces_doubled, 0u);
  EXPECT_NEAR(volume(surface.triangles), nx * ny * nz, 1e-9);
  EXPECT_EQ(surface.components, nx * ny * nz);
  for (const double cell_volume : component_volumes(surface)) EXPECT_NEAR(cell_volume, 1, 1e-9);
}

TEST(Walls, OfBlocksOfCellsLeaveTheOutlineAndPartTheCells) {
  for (const auto& [x, y, z] : {std::array{2, 1, 1}, {3, 1, 1}, {2, 2, 1}, {2, 2, 2}, {3, 3, 3}})
    for (const bool inward : {false, true}) {
      SCOPED_TRACE(testing::Message() << x << ' ' << y << ' ' << z << ' ' << inward);
      const PolygonSoup soup = cells(x, y, z);
      expect_block(clean(inward ? shapes::inverted(soup) : soup), x, y, z);
    }
}

TEST(Walls, AreFoundWhereCellsShareTheirPointsAndWhereEachFaceHasItsOwn) {
  const PolygonSoup soup = cells(2, 2, 2);
  expect_block(clean(shapes::burst(soup)), 2, 2, 2);
  PolygonSoup joined;  // points by their place, as exporters of voxels write them
  for (int i = 0; i < 27; ++i) joined.points.emplace_back(i / 9, i / 3 % 3, i % 3);
  for (auto polygon : soup.polygons) {
    for (int& corner : polygon) {
      const Vec3& at = soup.points[corner];
      corner = static_cast<int>(9 * at.x() + 3 * at.y() + at.z());
    }
    joined.polygons.push_back(polygon);
  }
  expect_block(clean(joined), 2, 2, 2);
}

TEST(Walls, OfCellsThatMeetAtFacesEdgesAndCornersGiveEachPlaceItsWinding) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 20; ++trial) {
    PolygonSoup soup;
    std::array<bool, 27> filled{};
    for (int i = 0; i < 27; ++i)
      if ((filled[i] = random() % 2 == 0))
        soup = shapes::together(soup, cell(Vec3(i / 9, i / 3 % 3, i % 3)));
    const Surface surface = clean(soup);
    EXPECT_TRUE(surface.closed());
    for (int i = 0; i < 27; ++i)
      EXPECT_NEAR(
          laws::winding_number(surface.triangles, Vec3(i / 9 + 0.4, i / 3 % 3 + 0.6, i % 3 + 0.3)),
          filled[i] ? 1 : 0, 1e-9)
          << trial << ' ' << i;
    const std::vector<double> volumes = component_volumes(surface);
    EXPECT_NEAR(std::accumulate(volumes.begin(), volumes.end(), 0.0),
                std::count(filled.begin(), filled.end(), true), 1e-9);
  }
}

TEST(Walls, OfACoreInItsShellLeaveOneBall) {
  const PolygonSoup core = shapes::sphere(0.5, 3), outer = shapes::sphere(1, 3);
  const Surface ball =
      clean(shapes::together(shapes::together(outer, shapes::inverted(core)), core));
  EXPECT_EQ(ball.cleaning.faces_shared, core.polygons.size());
  EXPECT_DOUBLE_EQ(volume(ball.triangles), volume(clean(outer).triangles));
}

TEST(Walls, AreNoneOfATwoSidedMeshBesideAnother) {
  const PolygonSoup body = shapes::sphere(1, 2, Vec3(3, 0, 0));
  const Surface surface =
      clean(shapes::together(shapes::sphere(1, 2), shapes::together(body, shapes::inverted(body))));
  EXPECT_EQ(surface.cleaning.faces_shared, 0u);
  EXPECT_EQ(surface.cleaning.faces_doubled, body.polygons.size());
  EXPECT_DOUBLE_EQ(volume(surface.triangles), 2 * volume(clean(shapes::sphere(1, 2)).triangles));
}

TEST(Walls, AreNoneOfTheTwoSidedPartOfASkin) {
  PolygonSoup body = shapes::sphere(1, 3);
  for (std::size_t i = 0; i < 100; ++i) {
    body.polygons.push_back(body.polygons[i]);
    std::reverse(body.polygons.back().begin(), body.polygons.back().end());
  }
  const Surface surface = clean(body);
  EXPECT_TRUE(surface.closed());
  EXPECT_EQ(surface.cleaning.faces_doubled, 100u);
  EXPECT_EQ(surface.triangles.faces, clean(shapes::sphere(1, 3)).triangles.faces);
}

TEST(Walls, BesideTheTwoSidedPartOfASkinAreToldApart) {
  PolygonSoup soup = cells(2, 1, 1);
  soup.polygons.push_back({2, 0, 4, 6});  // the end of the first cell, inward
  const Surface surface = clean(soup);
  EXPECT_TRUE(surface.closed());
  EXPECT_EQ(surface.cleaning.faces_shared, 2u);
  EXPECT_NEAR(volume(surface.triangles), 2, 1e-12);
}

/// Four faces around a corner on one side of a block: half of each one's edges are within them.
TEST(Walls, BesideManyTwoSidedFacesAreToldApart) {
  PolygonSoup soup = cells(4, 4, 4);
  const std::size_t faces = soup.polygons.size();
  for (std::size_t f = 0; f < faces; ++f) {
    Vec3 middle = Vec3::Zero();
    for (const int corner : soup.polygons[f]) middle += soup.points[corner] / 4;
    if (middle.z() != 4 || (middle - Vec3(2, 2, 4)).norm() > 1) continue;
    soup.polygons.push_back(soup.polygons[f]);
    std::reverse(soup.polygons.back().begin(), soup.polygons.back().end());
  }
  ASSERT_EQ(soup.polygons.size(), faces + 4);
  const Surface surface = clean(soup);
  EXPECT_TRUE(surface.closed());
  EXPECT_EQ(surface.cleaning.faces_shared, walls_of(4, 4, 4));
  EXPECT_NEAR(volume(surface.triangles), 64, 1e-9);
}

}  // namespace sinew::walls_test

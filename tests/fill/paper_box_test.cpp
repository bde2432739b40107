// SPDX-License-Identifier: GPL-3.0-or-later
// The body of Komiya and Tokoi.
#include <gtest/gtest.h>

#include <sinew/core/particles.h>
#include <sinew/fill/pack.h>
#include <sinew/repair/read_surface.h>
#include "mesh/mesh_files.h"
#include "support/source_dir.h"

namespace sinew::paper_box_test {

const std::string paper_box = test::source_dir() + "/data/meshes/box.obj";

Surface paper_box_surface() { return read_surface(mesh_files::body_at(paper_box)); }

PackOptions with_radius(double radius) {
  PackOptions options;
  options.radius = radius;
  return options;
}

TEST(PaperBox, Has1062PointsInFileOrderAnd2120Triangles) {
  const PolygonSoup soup = read_polygons(paper_box);
  const Surface surface = paper_box_surface();
  EXPECT_EQ(surface.triangles.points.size(), 1062u);
  EXPECT_EQ(surface.triangles.faces.size(), 2120u);
  EXPECT_EQ(surface.triangles.points, soup.points);
  EXPECT_EQ(surface.cleaning.faces_turned, 0u);
}

TEST(PaperBox, Is11By11By49HalfPlanes) {
  const Vec3 size = bounds(paper_box_surface().triangles.points).sizes();
  const double plane = half_plane_spacing(0.010);
  EXPECT_LT((size - plane * Vec3(11, 11, 49)).norm(), 1e-15);
}

TEST(PaperBox, HoldsThePapers2965Particles) {
  const Filling filling = pack(paper_box_surface(), with_radius(0.010));
  EXPECT_EQ(filling.particles.size(), 2965u);
  EXPECT_EQ(filling.report.ties, 0u);
  EXPECT_EQ(filling.report.neighbors[12], (9u * 9 * 47 - 1) / 2);  // a half-plane within
}

}  // namespace sinew::paper_box_test

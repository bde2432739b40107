// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/shading.h>

#include <gtest/gtest.h>

#include "synthetic_run.h"

namespace sinew::shading_test {

TEST(Shading, box_of_quadrangles_shows_its_cells_and_its_twelve_edges) {
  const Shading skin = make_shading(synthetic_snapshot(0, 0).surface);
  EXPECT_EQ(skin.creases.size(), 4U * (8 + 10 + 25));
  const std::size_t quadrangles = 2 * (8 * 10 + 10 * 25 + 25 * 8);
  EXPECT_EQ(skin.lines.size(), 2 * quadrangles - skin.creases.size());
}

TEST(Shading, is_split_along_creases_so_that_sides_stay_flat) {
  const Triangles box = synthetic_snapshot(0, 0).surface;
  const Shading skin = make_shading(box);
  EXPECT_EQ(skin.source.size(), 2U * (9 * 11 + 11 * 26 + 26 * 9));
  for (const Vec3& normal : point_normals(skin.at(box.points)))
    EXPECT_NEAR(normal.cwiseAbs().maxCoeff(), 1, 1e-12);
}

TEST(Shading, keeps_all_edges_of_a_mesh_of_even_triangles) {
  const double h = std::sqrt(0.75);
  const Triangles rhomb{{{0, 0, 0}, {1, 0, 0}, {0.5, h, 0}, {1.5, h, 0}}, {{0, 1, 2}, {1, 3, 2}}};
  const Shading skin = make_shading(rhomb);
  EXPECT_EQ(skin.creases.size(), 4U);  // open edges
  EXPECT_EQ(skin.lines.size(), 1U);
}

}  // namespace sinew::shading_test

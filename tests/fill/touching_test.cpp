// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/fill/filled_sites.h>

#include <gtest/gtest.h>

#include <sinew/core/cell_grid.h>
#include <sinew/core/particles.h>
#include <sinew/mesh/clean.h>
#include "mesh/shapes.h"

namespace sinew::touching_test {

class TouchingInPacking : public testing::TestWithParam<Packing> {};
INSTANTIATE_TEST_SUITE_P(Touching, TouchingInPacking, testing::Values(Packing::fcc, Packing::hcp));

TEST_P(TouchingInPacking, CountsTheSitesWithin2r) {
  const double r = 0.06;
  const Surface surface = clean(shapes::torus(1, 0.3));
  const Lattice lattice = lattice_in(bounds(surface.triangles.points), GetParam(), r);
  const auto runs = inside_runs(lattice, surface).runs;
  const Touching found = touching_sites(lattice, runs);
  const auto lists = neighbors_within(positions_of(lattice, runs), rest_neighbor_range(r));
  ASSERT_EQ(found.neighbors.size(), count_of(runs));
  for (std::size_t i = 0; i < found.neighbors.size(); ++i)
    ASSERT_EQ(found.neighbors[i], static_cast<int>(lists.of(i).size()));
  EXPECT_EQ(found.groups, 1);
}

TEST_P(TouchingInPacking, TellsGroupsThatDoNotTouch) {
  const double r = 0.05;
  const auto ball = shapes::sphere(1, 3);
  for (const double gap : {-0.5, 6 * r}) {
    const Surface surface = clean(shapes::together(ball, shapes::moved(ball, Vec3(2 + gap, 0, 0))));
    const Lattice lattice = lattice_in(bounds(surface.triangles.points), GetParam(), r);
    const auto runs = inside_runs(lattice, surface).runs;
    const Touching found = touching_sites(lattice, runs);
    EXPECT_EQ(found.groups, gap > 0 ? 2 : 1);
    for (std::size_t i = 0; i < runs.size() && gap > 0; ++i)
      ASSERT_EQ(found.group[i], lattice.site(runs[i].row, runs[i].first).x() > 1 + gap / 2);
  }
}

}  // namespace sinew::touching_test

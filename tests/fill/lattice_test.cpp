// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/fill/lattice.h>

#include <gtest/gtest.h>

#include <sinew/core/particles.h>

namespace sinew::lattice_test {

Points sites_in(const Box& box, Packing packing, double radius) {
  const Lattice lattice = lattice_in(box, packing, radius);
  Points sites;
  for (const LatticeRow& row : lattice.rows)
    for (int n = 0; n < row.sites; ++n) sites.push_back(lattice.site(row, n));
  return sites;
}

Box cube(double half) { return {Vec3::Constant(-half), Vec3::Constant(half)}; }

int at_distance(const Points& sites, const Vec3& from, double distance) {
  int count = 0;
  for (const Vec3& site : sites)
    count += std::abs((site - from).norm() - distance) < 1e-9 * distance;
  return count;
}

class EachPacking : public testing::TestWithParam<Packing> {};
INSTANTIATE_TEST_SUITE_P(Lattice, EachPacking, testing::Values(Packing::fcc, Packing::hcp));

TEST_P(EachPacking, HasASiteAtTheBoxCenter) {
  const Box box(Vec3(1, 2, 3), Vec3(4, 4, 4));
  EXPECT_EQ(at_distance(sites_in(box, GetParam(), 0.1), box.center(), 0), 0);
  int there = 0;
  for (const Vec3& site : sites_in(box, GetParam(), 0.1)) there += site == box.center();
  EXPECT_EQ(there, 1);
}

TEST_P(EachPacking, HasTwelveNeighborsAt2rAndSixAtTwoRootTwoR) {
  const double r = 0.3;
  const Points sites = sites_in(cube(12 * r), GetParam(), r);
  int inner = 0;
  for (const Vec3& site : sites) {
    if (site.cwiseAbs().maxCoeff() > 8 * r) continue;
    ++inner;
    ASSERT_EQ(at_distance(sites, site, nearest_distance(r)), 12);
    ASSERT_EQ(at_distance(sites, site, second_distance(r)), 6);
  }
  EXPECT_GT(inner, 500);
}

TEST_P(EachPacking, HasNoTwoSitesCloserThan2r) {
  const double r = 0.3;
  const Points sites = sites_in(cube(6 * r), GetParam(), r);
  for (std::size_t i = 0; i < sites.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      ASSERT_GT((sites[i] - sites[j]).norm(), 2 * r * (1 - 1e-12));
}

TEST_P(EachPacking, HasOneSitePerV0) {
  const double half = 1, r = 0.02;
  const double expected = 8 / volume_per_particle(r);
  const double found = static_cast<double>(sites_in(cube(half), GetParam(), r).size());
  EXPECT_NEAR(found / expected, 1, 0.02);
  EXPECT_GE(lattice_size(cube(half), r).sites, found);
}

TEST_P(EachPacking, StepsBy2rAlongARow) {
  const Lattice lattice = lattice_in(cube(1), GetParam(), 0.1);
  for (const LatticeRow& row : lattice.rows)
    for (int n = 1; n < row.sites; ++n)
      ASSERT_NEAR((lattice.site(row, n) - lattice.site(row, n - 1)).norm(), 0.2, 1e-12);
}

TEST_P(EachPacking, StaysInTheBoxAndReachesIt) {
  const double r = 0.1;
  const Box box(Vec3(-1, -2, 0), Vec3(1, 2, 3));
  Box reached;
  for (const Vec3& site : sites_in(box, GetParam(), r)) reached.extend(site);
  EXPECT_TRUE(
      Box(box.min() - Vec3::Constant(1e-6), box.max() + Vec3::Constant(1e-6)).contains(reached));
  EXPECT_LT((box.sizes() - reached.sizes()).maxCoeff(), 4 * r);
}

TEST(Fcc, SitesAreTheEvenOnesOfAGridOfStepRootTwoR) {
  const double r = 0.1, step = half_plane_spacing(r);
  for (const Vec3& site : sites_in(cube(1), Packing::fcc, r)) {
    const Vec3 steps = site / step;
    ASSERT_LT((steps - steps.array().round().matrix()).norm(), 1e-9);
    ASSERT_EQ(std::lround(steps.sum()) % 2, 0);
  }
}

}  // namespace sinew::lattice_test

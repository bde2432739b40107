// SPDX-License-Identifier: GPL-3.0-or-later
// Cells that move with their particles.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include <sinew/core/particles.h>
#include <sinew/mesh/clean.h>
#include <sinew/volume/moving_cells.h>
#include "mesh/shapes.h"

namespace sinew::moving_cells_test {

constexpr double radius = 0.1;

Points rest_of(const Surface& surface, const PackOptions& options) {
  return positions_of(pack(surface, options).particles);
}

MovingCells ball_of(Packing packing, Points& rest) {
  const Surface surface = clean(shapes::sphere(1, 4));
  PackOptions options;
  options.packing = packing;
  options.radius = radius;
  rest = rest_of(surface, options);
  return {volume_cells(surface, options, rest), rest, radius};
}

TEST(MovingCells, FollowAffineMotionsExactly) {
  const Mat3 F = (Mat3() << 1.2, 0.3, -0.1, -0.4, 0.9, 0.2, 0.1, 0.25, 1.1).finished();
  const Vec3 shift(0.3, -2, 5);
  for (const Packing packing : {Packing::fcc, Packing::hcp, Packing::random, Packing::conformal}) {
    Points rest;
    const MovingCells cells = ball_of(packing, rest);
    Points moved;
    for (const Vec3& p : rest) moved.push_back(F * p + shift);
    const Points now = cells.at(moved);
    for (std::size_t i = 0; i < now.size(); ++i)
      ASSERT_LT((now[i] - F * cells.rest().points[i] - shift).norm(), 1e-12);
    for (const double J : cells.volume_ratios(now)) ASSERT_NEAR(J, F.determinant(), 1e-8);
  }
}

TEST(MovingCells, HaveVolumeRatioOneAtRest) {
  Points rest;
  const MovingCells cells = ball_of(Packing::fcc, rest);
  for (const double J : cells.volume_ratios(cells.at(rest))) ASSERT_NEAR(J, 1, 1e-9);
}

TEST(MovingCells, TakeValuesOfTheirParticles) {
  Points rest;
  const MovingCells cells = ball_of(Packing::fcc, rest);
  const std::vector<double> constant(rest.size(), 7.5);
  std::vector<std::int32_t> number(rest.size());
  std::iota(number.begin(), number.end(), 0);
  const auto reals = std::get<std::vector<double>>(cells.at_points(column("a", constant)).values);
  const auto whole =
      std::get<std::vector<std::int32_t>>(cells.at_points(column("n", number)).values);
  const Column vectors = cells.at_points(column("x", rest));
  ASSERT_EQ(vectors.components, 3);
  for (std::size_t i = 0; i < cells.rest().points.size(); ++i) {
    EXPECT_NEAR(reals[i], 7.5, 1e-12);
    if (cells.rest().id[i] >= 0) {
      EXPECT_EQ(whole[i], cells.rest().id[i]);
      EXPECT_EQ(std::get<std::vector<double>>(vectors.values)[3 * i], rest[whole[i]].x());
    }
    EXPECT_LT((rest[whole[i]] - cells.rest().points[i]).norm(), 2.5 * radius);
  }
}

/// All cells along a cut between two layers of particles are torn, and no other.
TEST(MovingCells, AreTornByACut) {
  Points rest;
  const MovingCells cells = ball_of(Packing::fcc, rest);
  const double cut = 0.5 * half_plane_spacing(radius);  // a layer lies at 0
  const auto above = [&](std::uint32_t i) { return rest[i].z() > cut; };
  std::vector<char> apart;
  for (const auto& [i, j] : cells.pairs()) apart.push_back(above(i) != above(j));
  EXPECT_GT(std::count(apart.begin(), apart.end(), 1), 100);
  const std::vector<std::int32_t> torn =
      cells.torn(apart, std::vector<double>(cells.rest().cells.size(), 1));
  const VolumeCells& body = cells.rest();
  for (std::size_t c = 0; c < body.cells.size(); ++c) {
    int on_top = 0, particles = 0;
    for (const std::uint32_t v : body.cells[c])
      if (const std::int32_t i = body.beside[v]; i >= 0) ++particles, on_top += above(i);
    EXPECT_EQ(torn[c], on_top > 0 && on_top < particles);
  }
}

/// Points of border cells follow both sides of a crack: where it opens, no cell spans it unmarked.
TEST(MovingCells, AreTornBesideACrackThatOpens) {
  Points rest;
  const MovingCells cells = ball_of(Packing::fcc, rest);
  Points now = rest;
  const auto above = [&](std::uint32_t i) {
    return rest[i].z() > 0.5 * half_plane_spacing(radius);
  };
  for (std::uint32_t i = 0; i < now.size(); ++i)
    if (above(i)) now[i].z() += 2 * radius;
  std::vector<char> apart;
  for (const auto& [i, j] : cells.pairs()) apart.push_back(above(i) != above(j));
  const std::vector<double> J = cells.volume_ratios(cells.at(now));
  const auto cut = cells.torn(apart, std::vector<double>(J.size(), 1)), torn = cells.torn(apart, J);
  int beside = 0;
  for (std::size_t c = 0; c < J.size(); ++c) {
    EXPECT_FALSE(torn[c] == 0 && J[c] > largest_whole) << J[c];
    EXPECT_TRUE(torn[c] == cut[c] || J[c] > largest_whole);
    beside += torn[c] - cut[c];
  }
  EXPECT_GT(beside, 0);
  const std::vector<char> whole(apart.size());
  for (const std::int32_t one : cells.torn(whole, std::vector<double>(J.size(), 2)))
    EXPECT_EQ(one, 0) << "where nothing breaks, cells may be stretched";
}

TEST(MovingCells, KnowNearestAndSecondNeighbors) {
  Points rest;
  const MovingCells cells = ball_of(Packing::fcc, rest);
  for (std::size_t k = 0; k < cells.pairs().size(); ++k) {
    const auto [i, j] = cells.pairs()[k];
    ASSERT_LT(i, j);
    ASSERT_NEAR((rest[i] - rest[j]).norm(),
                cells.touching()[k] ? nearest_distance(radius) : second_distance(radius), 1e-9);
  }
}

}  // namespace sinew::moving_cells_test

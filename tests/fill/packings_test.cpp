// SPDX-License-Identifier: GPL-3.0-or-later
// Packings that are no lattice: as many particles in a volume, inside the surface, evenly apart.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include <sinew/core/cell_grid.h>
#include <sinew/core/parallel.h>
#include <sinew/core/particles.h>
#include <sinew/core/system.h>
#include <sinew/fill/detail/isotropy.h>
#include <sinew/fill/detail/relax.h>
#include <sinew/fill/fill_limits.h>
#include <sinew/fill/pack.h>
#include <sinew/mesh/clean.h>
#include <sinew/mesh/surface_distance.h>
#include "mesh/shapes.h"
#include "support/expect_error.h"

namespace sinew::packings_test {

PackOptions options_of(Packing packing, double radius, int seed = 1) {
  PackOptions options;
  options.packing = packing;
  options.radius = radius;
  options.seed = seed;
  return options;
}

Surface ball() { return clean(shapes::sphere(1, 4)); }
Surface bar() { return clean(shapes::box({0, 0, 0}, {3, 1, 0.8})); }

/// A ball without its top.
Surface cup() {
  PolygonSoup soup = shapes::sphere(1, 4);
  std::erase_if(soup.polygons, [&](const auto& face) {
    return std::any_of(face.begin(), face.end(),
                       [&](int corner) { return soup.points[corner].z() > 0.8; });
  });
  return clean(soup);
}

void expect_spaced(const Filling& filling, double least) {
  const Points places = positions_of(filling.particles);
  const double r = filling.particles.radius;
  const NeighborLists near = neighbors_within(places, rest_neighbor_range(r));
  for (std::size_t i = 0; i < places.size(); ++i) {
    ASSERT_EQ(filling.neighbors[i], static_cast<int>(near.of(i).size()));
    for (const std::uint32_t j : near.of(i))
      ASSERT_GT((places[i] - places[j]).norm(), least * 2 * r);
  }
}

TEST(RandomPacking, HasOneParticlePerVolumeStrictlyInside) {
  for (const Surface& surface : {ball(), bar()}) {
    const Filling filling = pack(surface, options_of(Packing::random, 0.05));
    const double expected = volume(surface.triangles) / volume_per_particle(0.05);
    EXPECT_NEAR(static_cast<double>(filling.particles.size()) / expected, 1, 0.015);
    const SurfaceDistance distance(surface);
    for (std::size_t i = 0; i < filling.particles.size(); ++i)
      ASSERT_LT(distance.from(filling.particles.position(i)).distance, 0);
    expect_spaced(filling, 0.75);
    EXPECT_LT(filling.report.packed.center.norm() - filling.report.mesh.center.norm(), 0.01);
  }
}

/// The fraction of particles in shells of the body's volume: as many near the surface as inside.
TEST(RandomPacking, IsAsDenseAtTheSurfaceAsInside) {
  const Particles particles = pack(ball(), options_of(Packing::random, 0.03)).particles;
  std::vector<double> depths;
  for (std::size_t i = 0; i < particles.size(); ++i)
    depths.push_back(std::pow(particles.position(i).norm(), 3));
  std::array<double, 10> in = {};
  for (const double depth : depths) in[static_cast<std::size_t>(10 * depth)] += 1;
  for (const double count : in) EXPECT_NEAR(count / static_cast<double>(depths.size()), 0.1, 0.008);
}

TEST(RandomPacking, DependsOnItsSeedAndNotOnThreads) {
  const auto packed = [](int seed, int threads) {
    Filling filling;
    with_threads(threads, [&] {
      PackOptions options = options_of(Packing::random, 0.08, seed);
      options.volume_shares = true;
      filling = pack(bar(), options);
    });
    return filling;
  };
  const Filling one = packed(1, 1), two = packed(1, 3), other = packed(2, 1);
  EXPECT_EQ(state_hash(one.particles), state_hash(two.particles));
  EXPECT_EQ(one.volume_share, two.volume_share);
  EXPECT_NE(state_hash(one.particles), state_hash(other.particles));
}

/// Nothing is left of the lattice: no direction is preferred, and none of its distances.
TEST(RandomPacking, HasNoDirectionAndNoSecondShell) {
  const Filling filling = pack(ball(), options_of(Packing::random, 0.04));
  EXPECT_GT(filling.report.modulus_range[0], 0.97);
  EXPECT_LT(filling.report.modulus_range[1], 1.03);
  const NeighborLists near = neighbors_within(positions_of(filling.particles), 3 * 0.04);
  std::size_t second = 0, between = 0;
  for (std::size_t i = 0; i < filling.particles.size(); ++i)
    for (const std::uint32_t j : near.of(i)) {
      const double d =
          (filling.particles.position(i) - filling.particles.position(j)).norm() / 0.04;
      second += d > 2.78 && d < 2.88;
      between += d > 2.58 && d < 2.68;
    }
  EXPECT_LT(static_cast<double>(second), 2.5 * static_cast<double>(between));
}

TEST(RandomPacking, FillsOpenSurfacesLayersAndKeepsAClearance) {
  const Filling open = pack(cup(), options_of(Packing::random, 0.05));
  const Filling sites = pack(cup(), options_of(Packing::fcc, 0.05));
  EXPECT_NEAR(double(open.particles.size()) / double(sites.particles.size()), 1, 0.03);

  PackOptions layer = options_of(Packing::random, 0.03);
  layer.thickness = 0.2;
  for (const Vec3& place : positions_of(pack(ball(), layer).particles))
    ASSERT_NEAR(place.norm(), 1, 0.1 + 0.02);

  PackOptions clear = options_of(Packing::random, 0.05);
  clear.keep = Keep::sphere;
  for (const Vec3& place : positions_of(pack(ball(), clear).particles))
    ASSERT_LT(place.norm(), 0.95);
}

TEST(RandomPacking, VolumeSharesAreTheVolume) {
  PackOptions options = options_of(Packing::random, 0.06);
  options.volume_shares = true;
  const Filling filling = pack(bar(), options);
  double sum = 0;
  for (const double volume_share : filling.volume_share) sum += volume_share;
  EXPECT_NEAR(sum * volume_per_particle(0.06) / 2.4, 1, 0.01);
}

/// Half of two layers' distance below the surface, sqrt(8/3) r / 2.
TEST(ConformalPacking, HasItsOuterLayerOnTheOffsetSurface) {
  const double r = 0.04, offset = std::sqrt(8.0 / 3) / 2 * r;
  for (const Surface& surface : {ball(), bar()}) {
    const Filling filling = pack(surface, options_of(Packing::conformal, r));
    const SurfaceDistance distance(surface);
    std::size_t outer = 0, on_it = 0;
    double least = r;
    for (std::size_t i = 0; i < filling.particles.size(); ++i) {
      const double depth = -distance.from(filling.particles.position(i)).distance;
      least = std::min(least, depth);
      outer += depth < 1.8 * offset;
      on_it += std::abs(depth - offset) < 0.15 * r;
    }
    EXPECT_GT(least, 0.3 * offset);
    EXPECT_GT(static_cast<double>(on_it), 0.97 * static_cast<double>(outer));
    EXPECT_GT(static_cast<double>(on_it) * 2 * std::sqrt(3.0) * r * r,
              0.68 * area(surface.triangles));
    expect_spaced(filling, 0.7);
  }
}

/// A body deep inside has the sites that it has on the lattice.
TEST(ConformalPacking, IsTheLatticeInside) {
  const Points sites = positions_of(pack(ball(), options_of(Packing::fcc, 0.05)).particles);
  const Points places = positions_of(pack(ball(), options_of(Packing::conformal, 0.05)).particles);
  const CellGrid grid(places, 0.05);
  for (const Vec3& site : sites) {
    if (site.norm() > 1 - 8 * 0.05) continue;
    double nearest = 1;
    grid.for_each_near(
        site, [&](std::uint32_t j) { nearest = std::min(nearest, (places[j] - site).norm()); });
    ASSERT_LT(nearest, 1e-12);
  }
}

TEST(ConformalPacking, RefusesWhatHasNoOneSurface) {
  test::expect_bad_input([] { pack(cup(), options_of(Packing::conformal, 0.05)); },
                         {"conformal", "holes", "close_holes"});
  PackOptions layer = options_of(Packing::conformal, 0.05);
  layer.thickness = 0.1;
  test::expect_bad_input([&] { pack(ball(), layer); }, {"conformal", "thickness"});
  PackOptions verified = options_of(Packing::random, 0.05);
  verified.verify = true;
  test::expect_bad_input([&] { pack(ball(), verified); }, {"lattice", "verification"});
}

TEST(RandomPacking, RefusesMoreParticlesThanMemoryHolds) {
  const double fits = std::cbrt(volume(ball().triangles) / volume_per_particle(1) * 300 /
                                static_cast<double>(available_memory()));
  EXPECT_NO_THROW(wanted_radius(BodySpace(ball(), options_of(Packing::fcc, fits)),
                                options_of(Packing::fcc, fits)));
  test::expect_bad_input([&] { pack(ball(), options_of(Packing::random, fits)); },
                         {"GB", "of memory", "fits"});
}

/// Closed forms of the cubic crystal with C11 = 2 C12 = 2 C44.
TEST(Isotropy, OfTwelveEqualSpringsIsThatOfTheCrystal) {
  const auto [least, most] = pack(ball(), options_of(Packing::fcc, 0.1)).report.modulus_range;
  EXPECT_NEAR(most / least, 1.8, 0.02);
  DirectionalStiffness sheet;
  sheet.add({1, 0, 0}), sheet.add({0, 1, 0});
  EXPECT_EQ(sheet.modulus_range()[1], 0);
}

/// Two particles that overlap part until they no longer do, symmetrically; a fixed one does not
/// move.
TEST(Relax, PartsParticlesUntilTheyTouch) {
  Points two = {{0, 0, 0}, {0.3, 0, 0}};
  relax(two, {.distance = 1, .fixed = {0, 0}, .enough = 1e-9});
  EXPECT_GE((two[1] - two[0]).norm(), 1);
  EXPECT_LT((two[1] - two[0]).norm(), 1.2);
  EXPECT_NEAR((two[1] + two[0]).x(), 0.3, 1e-12);
  Points one = {{0, 0, 0}, {0.3, 0, 0}};
  relax(one, {.distance = 1, .fixed = {1, 0}, .enough = 1e-9});
  EXPECT_EQ(one[0].norm(), 0);
  EXPECT_GE(one[1].x(), 1);
}

}  // namespace sinew::packings_test

// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/fill/detail/near_surface.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <tuple>

#include <sinew/core/parallel.h>
#include <sinew/core/particles.h>
#include "mesh/shapes.h"

namespace sinew::near_surface_test {

using Far = Eigen::Matrix<long double, 3, 1>;

long double distance_to_side(const Far& p, const Far& a, const Far& b) {
  const Far way = b - a;
  const long double length2 = way.squaredNorm();
  const long double t = length2 > 0 ? std::clamp((p - a).dot(way) / length2, 0.0L, 1.0L) : 0.0L;
  return (p - a - t * way).norm();
}

/// To the plane where the foot lies in the face, else to the nearest side.
long double distance_to(const Far& p, const Far& a, const Far& b, const Far& c) {
  const Far normal = (b - a).cross(c - a);
  const auto inside = [&](const Far& from, const Far& to) {
    return normal.dot((to - from).cross(p - from)) >= 0;
  };
  if (normal.norm() > 0 && inside(a, b) && inside(b, c) && inside(c, a))
    return std::abs((p - a).dot(normal)) / normal.norm();
  return std::min(
      {distance_to_side(p, a, b), distance_to_side(p, b, c), distance_to_side(p, c, a)});
}

long double distance_to(const Vec3& site, const Triangles& surface) {
  const auto far = [](const Vec3& p) { return Far(p.cast<long double>()); };
  long double least = HUGE_VALL;
  for (const auto& [a, b, c] : surface.faces)
    least = std::min(least, distance_to(far(site), far(surface.points[a]), far(surface.points[b]),
                                        far(surface.points[c])));
  return least;
}

/// All sites near the surface and no other; those at the limit itself may go either way.
void expect_as_one_by_one(const Lattice& lattice, const Triangles& surface, double distance) {
  const auto runs = runs_near(lattice, surface, distance);
  const Box box = bounds(surface.points);
  const double rounding = 1e-15 * (box.sizes().norm() + (box.center() - lattice.origin).norm());
  auto run = runs.begin();
  for (int row = 0; row < static_cast<int>(lattice.rows.size()); ++row)
    for (int n = 0; n < lattice.rows[row].sites; ++n) {
      while (run != runs.end() && std::tie(run->row, run->last) <= std::tie(row, n)) ++run;
      const bool found = run != runs.end() && run->row == row && run->first <= n;
      const long double at = distance_to(lattice.site(lattice.rows[row], n), surface);
      if (std::abs(at - distance) <= 1e-9 * distance + rounding) continue;
      ASSERT_EQ(found, at <= distance)
          << "row " << row << ", site " << n << " at " << double(at) << ", limit " << distance;
    }
  for (std::size_t i = 1; i < runs.size(); ++i)
    ASSERT_TRUE(runs[i - 1].row < runs[i].row || runs[i - 1].last < runs[i].first);
}

class Random {
 public:
  explicit Random(unsigned seed) : bits_(seed) {}
  double number(double low, double high) { return low + (high - low) * (bits_() / 4294967296.0); }
  int below(int n) { return static_cast<int>(bits_() % n); }
  Vec3 vector(double most) {
    const double x = number(-most, most), y = number(-most, most);
    return {x, y, number(-most, most)};
  }

 private:
  std::mt19937 bits_;
};

/// A triangle of any size; slivers, needles, segments and points among them.
void add_triangle(Random& random, double extent, Triangles& triangles) {
  const double size = extent * std::pow(10, random.number(-3, 0));
  const Vec3 a = random.vector(extent), b = a + random.vector(size);
  Vec3 c = a + random.vector(size);
  const double thin = size * std::pow(10, random.number(-15, -1));
  const int kind = random.below(6);
  if (kind == 1) c = a + random.number(0, 1) * (b - a) + random.vector(thin);
  if (kind == 2) c = b + random.vector(thin);
  if (kind == 3) c = a;
  if (kind == 4) c = a + 0.5 * (b - a);
  const int first = static_cast<int>(triangles.points.size());
  triangles.points.insert(triangles.points.end(), {a, b, c});
  if (kind == 5) triangles.points.back() = triangles.points[first + 1] = a;
  triangles.faces.push_back({first, first + 1, first + 2});
}

Triangles triangles_of(const PolygonSoup& soup) {
  Triangles triangles{soup.points, {}};
  for (const auto& f : soup.polygons)
    for (std::size_t i = 2; i < f.size(); ++i) triangles.faces.push_back({f[0], f[i - 1], f[i]});
  return triangles;
}

Box cube(double half) { return {Vec3::Constant(-half), Vec3::Constant(half)}; }

std::int64_t count(const std::vector<Run>& runs) {
  std::int64_t sites = 0;
  for (const Run& run : runs) sites += run.sites();
  return sites;
}

class Near : public testing::TestWithParam<Packing> {};
INSTANTIATE_TEST_SUITE_P(Surface, Near, testing::Values(Packing::fcc, Packing::hcp));

TEST_P(Near, IsWhatEachSitesDistanceSays) {
  const double r = 0.1;
  const Lattice lattice = lattice_in(cube(1), GetParam(), r);
  Random random(2);
  for (int i = 0; i < 500; ++i) {
    Triangles triangles;
    for (int n = random.below(8); n >= 0; --n) add_triangle(random, 1.2, triangles);
    expect_as_one_by_one(lattice, triangles, r * std::pow(10, random.number(-2, 1.2)));
  }
}

TEST_P(Near, IsRightForFacesThatJustTouchASite) {
  const Lattice lattice = lattice_in(cube(0.4), GetParam(), 0.1);
  Random random(6);
  for (int i = 0; i < 1000; ++i) {
    Triangles triangles;
    add_triangle(random, 1, triangles);
    const double distance = 0.1 * std::pow(10, random.number(-8, 0.5));
    const double u = random.number(0, 1), v = random.number(0, 1 - u);
    const Points& p = triangles.points;
    const Vec3 beside = lattice.origin + random.vector(distance),
               on_it = p[0] + u * (p[1] - p[0]) + v * (p[2] - p[0]), way = beside - on_it;
    for (Vec3& point : triangles.points) point += way;
    expect_as_one_by_one(lattice, triangles, distance);
  }
}

/// Corners on sites, sides along rows, faces in layers: all at the limit of one case or another.
TEST_P(Near, IsRightForTrianglesThatFollowTheLattice) {
  const double r = 0.1;
  const Lattice lattice = lattice_in(cube(0.6), GetParam(), r);
  Random random(3);
  const auto any_site = [&] {
    const LatticeRow& row = lattice.rows[random.below(static_cast<int>(lattice.rows.size()))];
    return lattice.site(row, random.below(std::max(1, row.sites)));
  };
  for (int i = 0; i < 500; ++i) {
    Triangles triangles{{any_site(), any_site(), any_site()}, {{0, 1, 2}}};
    if (i % 2) triangles.points[1].z() = triangles.points[2].z() = triangles.points[0].z();
    if (i % 3 == 0) triangles.points[1] = lattice.site({{0, 0, 0}, 1}, random.below(9));
    if (i % 3 == 0) triangles.points[0] = lattice.origin;
    expect_as_one_by_one(lattice, triangles, r * random.number(0.001, 4));
  }
}

TEST_P(Near, FindsTheSitesOnAPointOrAFaceAtATinyDistance) {
  const double r = 0.1;
  const Lattice lattice = lattice_in(cube(1), GetParam(), r);
  const Triangles point{{lattice.origin}, {{0, 0, 0}}};
  EXPECT_EQ(count(runs_near(lattice, point, 1e-9 * r)), 1);
  EXPECT_EQ(count(runs_near(lattice, point, 2.001 * r)), 13);
  EXPECT_EQ(count(runs_near(lattice, point, 1.999 * r)), 1);
  const Triangles layer{{{-9, -9, 0}, {9, -9, 0}, {0, 18, 0}}, {{0, 1, 2}}};
  int in_layer = 0;
  for (const LatticeRow& row : lattice.rows) in_layer += row.first[2] == 0 ? row.sites : 0;
  EXPECT_EQ(count(runs_near(lattice, layer, 1e-9 * r)), in_layer);
}

TEST_P(Near, KnowsNoOriginAndNoSize) {
  for (const double scale : {1e-6, 1e6})
    for (const double away : {0.0, 1e3}) {
      const Vec3 center = scale * away * Vec3(1, -2, 3);
      const Lattice lattice =
          lattice_in({center - Vec3::Constant(scale), center + Vec3::Constant(scale)}, GetParam(),
                     0.2 * scale);
      Random random(4);
      for (int i = 0; i < 50; ++i) {
        Triangles triangles;
        add_triangle(random, 1, triangles);
        for (Vec3& p : triangles.points) p = center + scale * p;
        expect_as_one_by_one(lattice, triangles, scale * random.number(0.01, 1));
      }
    }
}

TEST_P(Near, FillsAShellOfItsVolume) {
  const double r = 0.02;
  const Lattice lattice = lattice_in(cube(1.5), GetParam(), r);
  const Triangles ball = triangles_of(shapes::sphere(1, 5));
  for (const double distance : {r, 3 * r, 10 * r}) {
    const double shell = 4 * pi / 3 * (std::pow(1 + distance, 3) - std::pow(1 - distance, 3));
    const double sites = static_cast<double>(count(runs_near(lattice, ball, distance)));
    EXPECT_NEAR(sites * volume_per_particle(r) / shell, 1, 0.03);
  }
}

TEST_P(Near, GrowsWithTheDistanceUntilAllSitesAreIn) {
  const Lattice lattice = lattice_in(cube(1), GetParam(), 0.05);
  const Triangles ball = triangles_of(shapes::sphere(0.7, 2));
  auto before = runs_near(lattice, ball, 0);
  for (const double distance : {0.01, 0.1, 0.4, 1.0, 2.0, 1e9}) {
    const auto runs = runs_near(lattice, ball, distance);
    EXPECT_TRUE(runs_without(before, runs).empty());
    before = runs;
  }
  EXPECT_EQ(count(before), static_cast<std::int64_t>(lattice.sites()));
}

TEST_P(Near, IsTheSameForEveryOrderAndNumberOfThreads) {
  const Lattice lattice = lattice_in(cube(1.1), GetParam(), 0.02);
  Triangles torus = triangles_of(shapes::torus(0.7, 0.3, 64, 64));
  const auto runs = runs_near(lattice, torus, 0.05);
  for (const int threads : {1, 2, 7})
    with_threads(threads, [&] { EXPECT_EQ(runs_near(lattice, torus, 0.05), runs); });
  std::shuffle(torus.faces.begin(), torus.faces.end(), std::mt19937(5));
  EXPECT_EQ(runs_near(lattice, torus, 0.05), runs);
}

TEST_P(Near, IsEmptyForNothingAndForWhatIsFarOff) {
  const Lattice lattice = lattice_in(cube(1), GetParam(), 0.2);
  EXPECT_TRUE(runs_near(lattice, {}, 1).empty());
  EXPECT_TRUE(runs_near(lattice, triangles_of(shapes::sphere(50, 1)), 1).empty());
  const auto moved = shapes::moved(shapes::sphere(1, 1), Vec3(9, 0, 0));
  EXPECT_TRUE(runs_near(lattice, triangles_of(moved), 1).empty());
}

}  // namespace sinew::near_surface_test

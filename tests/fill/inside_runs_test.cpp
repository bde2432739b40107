// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/fill/inside_runs.h>

#include <gtest/gtest.h>

#include <random>

#include <sinew/core/parallel.h>
#include <sinew/core/particles.h>
#include <sinew/fill/detail/verify.h>
#include <sinew/fill/filled_sites.h>
#include <sinew/mesh/clean.h>
#include "mesh/shapes.h"

namespace sinew::inside_runs_test {

Lattice lattice_about(const Surface& surface, Packing packing, double radius,
                      const std::optional<Vec3>& origin = std::nullopt) {
  return lattice_in(bounds(surface.triangles.points), packing, radius, origin);
}

/// The generalized winding number from the solid angles of all faces (van Oosterom and Strackee).
double winding_number(const Triangles& surface, const Vec3& from) {
  double angle = 0;
  for (const auto& [i, j, k] : surface.faces) {
    const Vec3 a = surface.points[i] - from, b = surface.points[j] - from,
               c = surface.points[k] - from;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    angle += 2 * std::atan2(a.dot(b.cross(c)),
                            la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return angle / (4 * pi);
}

/// Sites on the wrong side of one half, of those off the surface whose winding number is not too
/// close to it.
std::size_t wrong_sites(const Surface& surface, const Lattice& lattice) {
  const InsideRuns inside = inside_runs(lattice, surface);
  std::size_t wrong = 0;
  auto next = inside.runs.begin();
  for (std::int32_t row = 0; row < static_cast<std::int32_t>(lattice.rows.size()); ++row)
    for (int n = 0; n < lattice.rows[row].sites; ++n) {
      while (next != inside.runs.end() &&
             (next->row < row || (next->row == row && next->last <= n)))
        ++next;
      const bool taken = next != inside.runs.end() && next->row == row && next->first <= n;
      if (std::binary_search(inside.on_surface.begin(), inside.on_surface.end(), RowSite{row, n}))
        continue;
      const double w = winding_number(surface.triangles, lattice.site(row, n));
      wrong += std::abs(w - 0.5) > 1e-9 && taken != (w > 0.5);
    }
  return wrong;
}

PolygonSoup rotated(PolygonSoup soup, double angle) {
  const Eigen::AngleAxisd turn(angle, Vec3(1, 2, 3).normalized());
  for (Vec3& point : soup.points) point = turn * point;
  return soup;
}

class InsideRunsOfPacking : public testing::TestWithParam<Packing> {};
INSTANTIATE_TEST_SUITE_P(InsideRuns, InsideRunsOfPacking,
                         testing::Values(Packing::fcc, Packing::hcp));

TEST_P(InsideRunsOfPacking, AgreesWithCgalOnClosedBodies) {
  const auto ball = shapes::sphere(1, 3, Vec3(0.1, 0.2, 0.3)), ring = shapes::torus(1, 0.4);
  const auto cube = shapes::box({0, 0, 0}, {1, 1, 1});
  for (const auto& body : {ball, ring, cube, rotated(cube, 0.5), rotated(ring, 1.1),
                           shapes::tetrahedron(), shapes::sphere(1, 0)})
    for (const double radius : {0.2, 0.0625, 0.031}) {
      const Surface surface = clean(body);
      const Lattice lattice = lattice_about(surface, GetParam(), radius);
      const InsideRuns inside = inside_runs(lattice, surface);
      const Verification found = verify(lattice, surface, inside);
      EXPECT_EQ(found.mismatches, 0u);
      EXPECT_EQ(found.on_surface, inside.on_surface.size());
    }
}

/// Bodies whose corners are sites: rows meet edges and corners, and lie in faces.
TEST_P(InsideRunsOfPacking, AgreesWithCgalWhereSitesAreCorners) {
  const Vec3 wide = Vec3::Constant(1.01);
  const Vec3 unit = lattice_in({-wide, wide}, GetParam(), 0.1).unit;
  for (const auto& body : {shapes::box(-Vec3::Ones(), Vec3::Ones()), shapes::sphere(1, 0),
                           shapes::box({-1, -1, 0}, Vec3::Ones())})
    for (const double steps : {6, 4, 2}) {
      PolygonSoup on_sites = body;
      for (Vec3& point : on_sites.points) point = point.cwiseProduct(steps * unit);
      const Surface surface = clean(on_sites);
      const Lattice lattice = lattice_in({-wide, wide}, GetParam(), 0.1, Vec3(Vec3::Zero()));
      const InsideRuns inside = inside_runs(lattice, surface);
      const Verification found = verify(lattice, surface, inside);
      EXPECT_EQ(found.mismatches, 0u);
      EXPECT_EQ(found.on_surface, inside.on_surface.size());
      EXPECT_GT(found.on_surface, 3u);
    }
}

TEST_P(InsideRunsOfPacking, AgreesWithCgalOnAHollowBody) {
  const Surface surface =
      clean(shapes::together(shapes::sphere(1, 3), shapes::inverted(shapes::torus(0.5, 0.2))));
  const Lattice lattice = lattice_about(surface, GetParam(), 0.04);
  EXPECT_EQ(verify(lattice, surface, inside_runs(lattice, surface)).mismatches, 0u);
}

TEST_P(InsideRunsOfPacking, FollowsTheWindingNumberOfOpenSurfaces) {
  const auto ball = shapes::sphere(1, 3);
  for (const auto& body :
       {shapes::without(ball, 0.05), shapes::without(ball, 0.3),
        shapes::without(shapes::torus(1, 0.4), 0.1),
        shapes::without(shapes::box({0, 0, 0}, {1, 1, 1}), 0.2), shapes::torn(ball, 0.01)}) {
    const Surface surface = clean(body);
    ASSERT_FALSE(surface.closed());
    EXPECT_EQ(wrong_sites(surface, lattice_about(surface, GetParam(), 0.07)), 0u);
  }
}

/// Each triangle by itself: every edge is open.
TEST_P(InsideRunsOfPacking, FollowsTheWindingNumberOfSeparateTriangles) {
  for (const double size : {0.98, 0.85, 0.75}) {
    const Surface surface = clean(shapes::burst(shapes::bumpy_ball(3), size));
    ASSERT_EQ(surface.border.edges, 3 * surface.triangles.faces.size());
    EXPECT_EQ(wrong_sites(surface, lattice_about(surface, GetParam(), 0.05)), 0u);
  }
}

/// Rows that meet the border's edges and corners, and lie in the plane of a hole.
TEST_P(InsideRunsOfPacking, FollowsTheWindingNumberWhereSitesAreOnTheBorder) {
  const Vec3 wide = Vec3::Constant(1.01);
  const Lattice lattice = lattice_in({-wide, wide}, GetParam(), 0.1, Vec3(Vec3::Zero()));
  for (std::size_t missing = 0; missing < 6; ++missing) {
    PolygonSoup body = shapes::box(-6 * lattice.unit, 6 * lattice.unit);
    body.polygons.erase(body.polygons.begin() + static_cast<std::ptrdiff_t>(missing));
    EXPECT_LE(wrong_sites(clean(body), lattice), 0u) << missing;
  }
}

TEST(InsideRuns, AreThoseOfTheWholeBodyForDefectsThatDoNotOpenIt) {
  const auto ring = shapes::torus(1, 0.4);
  const Surface whole = clean(ring);
  const Lattice lattice = lattice_about(whole, Packing::fcc, 0.04);
  const auto expected = inside_runs(lattice, whole).runs;
  EXPECT_GT(expected.size(), 100u);
  for (const auto& body :
       {shapes::together(ring, ring), shapes::inverted(ring), shapes::torn(ring, 0),
        shapes::together(ring, shapes::inverted(ring)), shapes::flipped(ring, 0.1)})
    EXPECT_EQ(inside_runs(lattice, clean(body)).runs, expected);
}

TEST(InsideRuns, UniteOverlappingPartsIntoOneBody) {
  const auto left = shapes::sphere(1, 3), right = shapes::moved(left, Vec3(0.9, 0.1, 0));
  const Surface both = clean(shapes::together(left, shapes::inverted(right)));
  const Lattice lattice = lattice_about(both, Packing::fcc, 0.05);
  const InsideRuns inside = inside_runs(lattice, both);
  EXPECT_EQ(inside.deepest, 2);
  EXPECT_EQ(inside.bodies, 1);
  std::size_t expected = 0;
  const Surface one = clean(left), other = clean(right);
  for (const LatticeRow& row : lattice.rows)
    for (int n = 0; n < row.sites; ++n)
      expected += winding_number(one.triangles, lattice.site(row, n)) +
                      winding_number(other.triangles, lattice.site(row, n)) >
                  0.5;
  EXPECT_EQ(count_of(inside.runs), expected);
}

/// Sites on a face that two boxes share are inside of one of them.
TEST(InsideRuns, OfTouchingBoxesAreThoseOfTheBlockAndTellThemApart) {
  PolygonSoup boxes;
  for (int i = 0; i < 8; ++i) {
    const Vec3 low(i % 2, i / 2 % 2, i / 4);
    boxes = shapes::together(boxes, shapes::box(low, low + Vec3::Ones()));
  }
  const Surface apart = clean(boxes), block = clean(shapes::box({0, 0, 0}, {2, 2, 2}));
  for (const Packing packing : {Packing::fcc, Packing::hcp}) {
    const Lattice lattice = lattice_about(block, packing, 0.06, Vec3(1, 1, 1));
    const InsideRuns inside = inside_runs(lattice, apart), whole = inside_runs(lattice, block);
    EXPECT_EQ(count_of(inside.runs), count_of(whole.runs));
    EXPECT_EQ(inside.on_surface, whole.on_surface);
    EXPECT_EQ(inside.deepest, 1);
    EXPECT_EQ(inside.bodies, 8);
    EXPECT_EQ(inside.block_of, std::vector<int>(8, 0));
    for (const auto& run : inside.runs)
      for (int n = run.first; n < run.last; ++n) {
        const Vec3 site = lattice.site(lattice.rows[run.row], n);
        const Vec3 low(run.body % 2, run.body / 2 % 2, run.body / 4);
        ASSERT_LE(low.maxCoeff(), 1);
        ASSERT_GE((site - low).minCoeff(), 0);
        ASSERT_LE((site - low).maxCoeff(), 1);
      }
  }
}

/// Two boxes whose facing sides have long slits: between them places are far from the slits'
/// corners and close to their edges.
TEST(InsideRuns, FollowTheWindingNumberBesideLongSlits) {
  PolygonSoup slits;
  const auto quad = [&](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const int first = static_cast<int>(slits.points.size());
    slits.points.insert(slits.points.end(), {a, b, c, d});
    slits.polygons.push_back({first, first + 1, first + 2, first + 3});
  };
  for (const bool left : {true, false}) {
    PolygonSoup box =
        left ? shapes::box({-1, 0, 0}, {0, 1, 1}) : shapes::box({0.1, 0, 0}, {1.1, 1, 1});
    box.polygons.erase(box.polygons.begin() + (left ? 5 : 4));
    slits = shapes::together(slits, box);
    const double x = left ? 0 : 0.1;
    const auto face = [&](double y0, double y1, double z0, double z1) {
      const Vec3 a(x, y0, z0), b(x, y1, z0), c(x, y1, z1), d(x, y0, z1);
      left ? quad(a, b, c, d) : quad(a, d, c, b);
    };
    face(0, 0.48, 0, 1), face(0.52, 1, 0, 1), face(0.48, 0.52, 0, 0.05), face(0.48, 0.52, 0.95, 1);
  }
  const Surface surface = clean(slits);
  ASSERT_FALSE(surface.closed());
  EXPECT_EQ(wrong_sites(surface, lattice_about(surface, Packing::hcp, 0.014)), 0u);
}

/// A part that encloses nothing in sum still has an inside where it turns outward.
TEST(InsideRuns, OfAPartWithoutVolumeBelongToABody) {
  PolygonSoup twisted = shapes::box({3, 0, 0}, {5, 1, 1});
  for (const int point : {1, 3, 5, 7})  // one end upside down: a bow tie
    twisted.points[point].z() = 1 - twisted.points[point].z();
  const Surface surface = clean(shapes::together(shapes::box({0, 0, 0}, {1, 1, 1}), twisted));
  const InsideRuns inside = inside_runs(lattice_about(surface, Packing::fcc, 0.05), surface);
  for (const auto& run : inside.runs) {
    ASSERT_GE(run.body, 0);
    ASSERT_LT(run.body, inside.bodies);
  }
}

TEST(InsideRuns, AreTheSameForAnyNumberOfThreadsAndOrderOfFaces) {
  PolygonSoup body = shapes::without(shapes::torus(1, 0.4), 0.1);
  const Lattice lattice = lattice_about(clean(body), Packing::fcc, 0.03);
  const auto expected = inside_runs(lattice, clean(body)).runs;
  for (const int threads : {1, 2, 3, 8})
    with_threads(threads, [&] { EXPECT_EQ(inside_runs(lattice, clean(body)).runs, expected); });
  std::reverse(body.polygons.begin(), body.polygons.end());
  EXPECT_EQ(inside_runs(lattice, clean(body)).runs, expected);
}

TEST(InsideRuns, MoveWithTheBody) {
  PolygonSoup body = shapes::sphere(1, 3);
  for (Vec3& point : body.points)  // multiples of 1/1024, so that moving loses no digit
    for (double& x : point) x = std::round(x * 1024) / 1024;
  const Surface here = clean(body), there = clean(shapes::moved(body, Vec3(4, -8, 2)));
  EXPECT_EQ(inside_runs(lattice_about(there, Packing::fcc, 0.05), there).runs,
            inside_runs(lattice_about(here, Packing::fcc, 0.05), here).runs);
}

TEST(AmbiguousFraction, TellsWhatHasNoInside) {
  PolygonSoup scattered;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-1, 1);
  for (int i = 0; i < 300; ++i) {
    scattered.polygons.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    for (int corner = 0; corner < 3; ++corner)
      scattered.points.emplace_back(place(random), place(random), place(random));
  }
  const auto fraction = [](const PolygonSoup& soup) {
    const Surface surface = clean(soup);
    return ambiguous_fraction(lattice_about(surface, Packing::fcc, 0.05), surface);
  };
  EXPECT_GT(fraction(scattered), 0.7);
  EXPECT_EQ(fraction(shapes::sphere(1, 3)), 0);
  EXPECT_LT(fraction(shapes::without(shapes::sphere(1, 3), 0.05)), 0.2);
}

}  // namespace sinew::inside_runs_test

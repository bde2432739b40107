// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/fill/detail/cap_tree.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include <sinew/core/parallel.h>
#include "mesh/shapes.h"

namespace sinew::cap_tree_test {

std::vector<CapCorners> corners_of(const PolygonSoup& soup) {
  const Triangles triangles = shapes::triangles_of(soup);
  std::vector<CapCorners> caps;
  for (const auto& [a, b, c] : triangles.faces)
    caps.push_back({triangles.points[a], triangles.points[b], triangles.points[c]});
  return caps;
}

/// Triangles of any size and direction in a ball.
std::vector<CapCorners> random_triangles(int count) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const auto any = [&] { return Vec3(normal(random), normal(random), normal(random)); };
  std::vector<CapCorners> caps;
  for (int i = 0; i < count; ++i) {
    const Vec3 at = any();
    const double size = std::exp(normal(random)) / 10;
    caps.push_back({at + size * any(), at + size * any(), at + size * any()});
  }
  return caps;
}

/// The solid angle over 4 pi (van Oosterom and Strackee).
double winding_of(const CapCorners& cap, const Vec3& eye) {
  const Vec3 a = cap[0] - eye, b = cap[1] - eye, c = cap[2] - eye;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2 *
         std::atan2(a.dot(b.cross(c)),
                    la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb) /
         (4 * pi);
}

TEST(SolidHarmonics, AddUpToTheInverseDistance) {
  const Vec3 h(0.2, -0.1, 0.25), t(1, 2, -1.5), a(0.3, 0.5, -0.7), shift(0.05, 0.1, -0.2);
  const auto u = regular_harmonics<16>(h);
  EXPECT_NEAR(field_of(u, t), 1 / (t - h).norm(), 1e-12);
  const auto moments = derivative_along(a, u);
  EXPECT_NEAR(field_of(moments, t), a.dot(t - h) / std::pow((t - h).norm(), 3), 1e-12);
  const Vec3 moved = t - h - shift;
  EXPECT_NEAR(field_of(shifted_moments(moments, shift), t),
              a.dot(moved) / std::pow(moved.norm(), 3), 1e-12);
}

TEST(CapTree, HoldsEachCapOnce) {
  std::vector<int> order = CapTree(random_triangles(101)).order();
  std::sort(order.begin(), order.end());
  for (int i = 0; i < 101; ++i) EXPECT_EQ(order[i], i);
  EXPECT_EQ(CapTree({}).far_field(Vec3::Zero(), 2, [](int, int) { FAIL(); }).winding, 0);
}

/// The distant caps one by one.
TEST(CapTree, BoundsTheErrorOfTheFarField) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (const auto& caps : {corners_of(shapes::burst(shapes::sphere(1, 3), 0.9)),
                           corners_of(shapes::sphere(0.5, 2)), random_triangles(500)}) {
    const CapTree tree(caps);
    for (const double farness : {1.01, 1.2, 2.0, 3.5, 8.0})
      for (int i = 0; i < 40; ++i) {
        const Vec3 eye(normal(random), normal(random), normal(random));
        double expected = 0;
        std::vector<bool> distant(caps.size(), true);
        const auto far = tree.far_field(eye, farness, [&](int first, int last) {
          for (int k = first; k < last; ++k) distant[tree.order()[k]] = false;
        });
        for (std::size_t k = 0; k < caps.size(); ++k) {
          if (!distant[k]) continue;
          expected += winding_of(caps[k], eye);
          for (const Vec3& corner : caps[k]) EXPECT_LE(far.clearance, (corner - eye).norm());
        }
        EXPECT_LE(std::abs(far.winding - expected), far.doubt + 1e-13);
        EXPECT_LT(far.doubt, farness < 8 ? HUGE_VAL : 1e-3);
      }
  }
}

/// All area at one end of a node and across its axis, the point beyond that end: no terms cancel.
TEST(CapTree, BoundsTheErrorClosely) {
  const auto tiny = [](double size, double z) -> CapCorners {
    return {Vec3(size, 0, z), Vec3(-size, size, z), Vec3(-size, -size, z)};
  };
  const std::vector<CapCorners> caps = {tiny(0.01, 1), tiny(0, -1)};
  const CapTree tree(caps);
  for (const double distance : {1.5, 2.0, 3.0, 5.0}) {
    const Vec3 eye(0, 0, distance);
    const auto far = tree.far_field(eye, 1.2, [](int, int) { FAIL(); });
    const double error = std::abs(far.winding - winding_of(caps[0], eye));
    EXPECT_LE(error, far.doubt);
    EXPECT_GE(error, 0.9 * far.doubt);
  }
}

TEST(CapTree, IsTheSameForAnyNumberOfThreads) {
  const auto caps = random_triangles(5000);
  const auto field = [&](int threads) {
    double found = 0;
    with_threads(threads, [&] {
      found = CapTree(caps).far_field({2, 1, 3}, 1.5, [](int, int) {}).winding;
    });
    return found;
  };
  EXPECT_EQ(field(1), field(3));
}

}  // namespace sinew::cap_tree_test

// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/triangles.h>

#include <gtest/gtest.h>

#include "support/world.h"

namespace sinew::triangles_test {

Triangles tetrahedron(const Vec3& at) {
  return {{at, at + Vec3::UnitX(), at + Vec3::UnitY(), at + Vec3::UnitZ()},
          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

/// The box [0, size] with two triangles per side, moved by `at`.
Triangles box(const Vec3& size, const Vec3& at) {
  Triangles surface;
  for (int corner = 0; corner < 8; ++corner)
    surface.points.push_back(
        at + size.cwiseProduct(Vec3(corner & 1, (corner >> 1) & 1, (corner >> 2) & 1)));
  for (const auto& [a, b, c, d] : {std::array{0, 2, 3, 1},
                                   {4, 5, 7, 6},
                                   {0, 1, 5, 4},
                                   {2, 6, 7, 3},
                                   {0, 4, 6, 2},
                                   {1, 3, 7, 5}})
    surface.faces.insert(surface.faces.end(), {{a, b, c}, {a, c, d}});
  return surface;
}

TEST(Triangles, VolumeAndAreaOfBoxAndTetrahedron) {
  EXPECT_DOUBLE_EQ(volume(box({2, 3, 5}, {0, 0, 0})), 30);
  EXPECT_DOUBLE_EQ(area(box({2, 3, 5}, {0, 0, 0})), 62);
  EXPECT_DOUBLE_EQ(volume(tetrahedron({0, 0, 0})), 1.0 / 6);
  EXPECT_DOUBLE_EQ(area(tetrahedron({0, 0, 0})), 1.5 + std::sqrt(3.0) / 2);
}

TEST(Triangles, VolumeAndAreaKeepDigitsFarFromTheOrigin) {
  const Vec3 far(1234567.8901, -2345678.9012, 987654.3210);  // corners are rounded to 2e-10
  EXPECT_NEAR(volume(box({2, 3, 5}, far)), 30, 1e-7);
  EXPECT_NEAR(area(box({2, 3, 5}, far)), 62, 1e-7);
  EXPECT_NEAR(volume(tetrahedron(far)), 1.0 / 6, 1e-8);
}

TEST(Triangles, VolumeIsNegativeInsideOutAndZeroForNothing) {
  Triangles surface = box({1, 1, 1}, {3, 3, 3});
  for (auto& face : surface.faces) std::swap(face[1], face[2]);
  EXPECT_DOUBLE_EQ(volume(surface), -1);
  EXPECT_EQ(volume({}), 0);
  EXPECT_EQ(area({}), 0);
}

TEST(Triangles, VolumeScalesWithTheDeterminant) {
  Triangles surface = box({1, 2, 3}, {5, 6, 7});
  const Mat3 F = (Mat3() << 1.1, 0.3, 0, -0.2, 0.9, 0.4, 0.1, 0, 1.3).finished();
  surface.points = test::affine(surface.points, F, {1, 1, 1});
  EXPECT_NEAR(volume(surface), 6 * F.determinant(), 1e-12);
}

TEST(Triangles, BoundsHoldAllPointsAndAreEmptyForNone) {
  const Box found = bounds({{1, 5, -3}, {-2, 6, 0}});
  EXPECT_EQ(found.min(), Vec3(-2, 5, -3));
  EXPECT_EQ(found.max(), Vec3(1, 6, 0));
  EXPECT_TRUE(bounds(Points{}).isEmpty());
}

TEST(PointNormals, PointOutwardsAndWeighFacesByArea) {
  const Points normals = point_normals(tetrahedron({1e6, 1e6, 1e6}));
  EXPECT_LT((normals[0] + Vec3(1, 1, 1).normalized()).norm(), 1e-14);
  // At (1, 0, 0) the slanted face has area vector (1, 1, 1)/2, the two others -z/2 and -y/2.
  EXPECT_LT((normals[1] - Vec3(1, 0, 0)).norm(), 1e-14);
}

TEST(PointNormals, AreZeroWhereNoFaceHasAnArea) {
  const Points normals = point_normals({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {5, 5, 5}}, {{0, 1, 2}}});
  for (const Vec3& normal : normals) EXPECT_EQ(normal, Vec3::Zero());
}

}  // namespace sinew::triangles_test

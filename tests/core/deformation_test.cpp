// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/deformation.h>

#include <gtest/gtest.h>
#include <random>

#include <sinew/core/parallel.h>
#include <sinew/core/particles.h>

#include "support/world.h"

namespace sinew::deformation_test {

using test::affine;
using test::random_matrix;
using test::turned;

RestShape box_shape(const Vec3& at = {0, 0, 0}) {
  Points points = test::fcc_box(5, 5, 7, 0.01);
  for (Vec3& point : points) point += at;
  return rest_shape(points, rest_neighbor_range(0.01));
}

void expect_gradient(const RestShape& rest, const Mat3& F, double tolerance) {
  for (const Mat3& found :
       test::deformation_gradients(rest, affine(rest.points, F, {0.3, -0.2, 0.1})))
    ASSERT_LT((found - F).cwiseAbs().maxCoeff(), tolerance);
}

TEST(DeformationGradient, IsExactForAffineMotion) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 10; ++trial)
    expect_gradient(box_shape(), Mat3::Identity() + random_matrix(random), 1e-12);
}

TEST(DeformationGradient, IsExactForInvertedAndFlattenedMotion) {
  expect_gradient(box_shape(), Vec3(1, 1, -1).asDiagonal(), 1e-12);
  expect_gradient(box_shape(), Vec3(1, 1, 0).asDiagonal(), 1e-12);
}

TEST(DeformationGradient, OfARigidMotionIsItsRotation) {
  const Mat3 R = turned({1, 2, 3}, 130);
  expect_gradient(box_shape(), R, 1e-12);
  EXPECT_LT((rotation_part(R) - R).norm(), 1e-14);
}

TEST(DeformationGradient, KeepsDigitsFarFromTheOrigin) {
  // Coordinates of 100 m hold 1.4e-14 m, that is 1e-12 of a neighbor's distance.
  const RestShape rest = box_shape({100, -100, 50});
  for (const Mat3& found :
       test::deformation_gradients(rest, affine(rest.points, turned({0, 1, 0}, 90))))
    ASSERT_LT((found - turned({0, 1, 0}, 90)).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(RestShape, HasTheSameBitsForEveryThreadCount) {
  const Points points = test::fcc_box(15, 15, 21, 0.01);
  const RestShape expected = rest_shape(points, rest_neighbor_range(0.01));
  for (const int threads : {1, 2, 3, 8})
    with_threads(threads, [&] {
      EXPECT_EQ(rest_shape(points, rest_neighbor_range(0.01)).inverse, expected.inverse);
    });
}

TEST(DeformationGradient, UsesOnlyTheNeighborsOfItsOwnPoint) {
  const RestShape rest = box_shape();
  Points now = rest.points;
  now.back() += Vec3(0.002, 0, 0);
  const auto gradients = test::deformation_gradients(rest, now);
  for (std::uint32_t i = 0; i + 1 < now.size(); ++i) {
    const auto row = rest.neighbors.of(i);
    const bool touches = std::find(row.begin(), row.end(), now.size() - 1) != row.end();
    EXPECT_EQ(touches, (gradients[i] - Mat3::Identity()).norm() > 1e-3) << i;
  }
}

TEST(DeformationGradient, IsUndefinedForPlanesLinesAndLonePoints) {
  const double r = 0.01;
  for (const Points& points : {test::fcc_box(7, 7, 1, r), test::fcc_box(9, 1, 1, r),
                               Points{Vec3(1, 1, 1)}, Points{{0, 0, 0}, {0.02, 0, 0}}}) {
    const Mat3 R = turned({1, 1, 1}, 40);
    const RestShape rest = rest_shape(affine(points, R), rest_neighbor_range(r));
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_FALSE(rest.defined(i));
      EXPECT_EQ(deformation_gradient(rest, affine(points, 2 * R), i), Mat3::Identity());
    }
  }
}

TEST(DeformationGradient, IsDefinedForEveryParticleOfAPackedBox) {
  const RestShape rest = box_shape();
  for (std::size_t i = 0; i < rest.points.size(); ++i) EXPECT_TRUE(rest.defined(i));
}

TEST(AffineFit, IsThatOfThePointsThatAreThere) {
  const RestShape rest = box_shape();
  std::mt19937 random(5);
  const Mat3 F = Mat3::Identity() + random_matrix(random);
  Points now = affine(rest.points, F);
  const std::size_t gone = now.size() / 2, moved = 0;
  now[gone].setConstant(std::numeric_limits<double>::quiet_NaN());
  now[moved] += Vec3(0.001, 0, 0);
  const auto near_moved = rest.neighbors.of(moved);
  for (std::size_t i = 0; i < now.size(); ++i) {
    const AffineFit fit = affine_fit(rest, now, i);
    const bool beside = std::find(near_moved.begin(), near_moved.end(), i) != near_moved.end();
    if (i == gone) {
      EXPECT_TRUE(fit.F.hasNaN() && std::isnan(fit.D2min));
    } else if (i == moved || beside) {
      EXPECT_GT((fit.F - F).norm(), 1e-3);
    } else {
      ASSERT_LT((fit.F - F).cwiseAbs().maxCoeff(), 1e-12) << i;
      EXPECT_LT(fit.D2min, 1e-28);
    }
  }
}

TEST(AffineFit, LeavesTheMeanSquareOfWhatIsNotAffine) {
  // Six neighbors on the axes: a motion that is even in dX has no affine part.
  const Points points{{0, 0, 0},  {1, 0, 0}, {-1, 0, 0}, {0, 1, 0},
                      {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  Points now = points;
  for (std::size_t i = 1; i <= 2; ++i) now[i] += Vec3(0, 0.3, 0);
  const RestShape rest = rest_shape(points, 1.1);
  const AffineFit fit = affine_fit(rest, now, 0);
  EXPECT_LT((fit.F - Mat3::Identity()).norm(), 1e-15);
  EXPECT_NEAR(fit.D2min, 2 * 0.09 / 6, 1e-15);
  EXPECT_NEAR(non_affine(rest, now, fit.F, 0), fit.D2min, 1e-15);
}

TEST(RotationPart, SplitsStretchFromRotation) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 50; ++trial) {
    const Mat3 R = turned(random_matrix(random).col(0), 150);
    const Mat3 A = Mat3::Identity() + random_matrix(random);
    const Mat3 U = A * A.transpose() + 0.01 * Mat3::Identity();
    EXPECT_LT((rotation_part(R * U) - R).norm(), 1e-12);
  }
}

TEST(RotationPart, IsProperForInvertedAndSingularGradients) {
  std::mt19937 random(3);
  const Mat3 R = turned({3, -1, 2}, 75);
  for (const Vec3& stretch : {Vec3(1.2, 1, -0.1), Vec3(-1, -1, -1), Vec3(1, 1, 0), Vec3(1, 0, 0),
                              Vec3(0, 0, 0), Vec3(1, 2, -3)}) {
    const Mat3 found = rotation_part(R * stretch.asDiagonal());
    EXPECT_NEAR(found.determinant(), 1, 1e-12);
    EXPECT_LT((found * found.transpose() - Mat3::Identity()).norm(), 1e-12);
  }
  // Inverted along its weakest direction only, the rotation stays what it was.
  EXPECT_LT((rotation_part(R * Vec3(1.2, 1, -0.1).asDiagonal()) - R).norm(), 1e-12);
  EXPECT_LT((rotation_part(R * Vec3(1.2, 1, 0).asDiagonal()) - R).norm(), 1e-12);
}

TEST(RotationPart, OfALineIsTheShortest) {
  std::mt19937 random(4);
  for (int trial = 0; trial < 50; ++trial) {
    const Vec3 from = random_matrix(random).col(0).normalized();
    const Vec3 to = trial == 0 ? Vec3(-from) : Vec3(random_matrix(random).col(1).normalized());
    const Mat3 R = rotation_part(2 * to * from.transpose());
    EXPECT_LT((R * from - to).norm(), 1e-12);
    EXPECT_LT((R * R.transpose() - Mat3::Identity()).norm(), 1e-12);
    EXPECT_NEAR(R.trace(), 1 + 2 * from.dot(to), 1e-12);  // 1 + 2 cos of the angle between them
  }
}

}  // namespace sinew::deformation_test

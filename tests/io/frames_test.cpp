// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/frames.h>

#include <gtest/gtest.h>

#include "synthetic_run.h"

namespace sinew::frames_test {

constexpr double rounding = 1e-14;

TEST(ObstaclesDataset, MovesEachSurfaceWithItsFrame) {
  const Dataset data = SyntheticRun().obstacles({0.5, 0});
  ASSERT_EQ(data.points.size(), 8U);
  EXPECT_EQ(data.points[0], Vec3(-1, -1, 0));
  EXPECT_EQ(data.points[4], Vec3(-1, -1, 0.5));
  EXPECT_EQ(data.connectivity[6], 4);
  EXPECT_EQ(integers(data.point_columns, "obstacle"),
            (std::vector<std::int32_t>{0, 0, 0, 0, 1, 1, 1, 1}));
  EXPECT_EQ(vectors(data.point_columns, "velocity")[4], Vec3(2, -2, 1));
  EXPECT_EQ(vectors(data.point_columns, "normal")[4], Vec3(0, 0, 1));
  EXPECT_EQ(vectors(data.point_columns, "reaction_force")[7], Vec3(0, 0, -2));
}

TEST(SupportsDataset, HasAPointForEachSupportAndLoad) {
  const std::vector<SupportFrame> both = {
      {false, {0, 0, 1}, {0, 0, 0.1}, {0, 0, 5}, {1, 0, 0}, 0.5},
      {true, {0, 0, 2}, {0, 0, 0.2}, {0, 0, -5}, {0, 1, 0}, -0.5}};
  const Dataset data = supports_dataset(both, {0.5, 7});
  EXPECT_EQ(data.cycle, 7);
  ASSERT_EQ(data.points.size(), 2U);
  EXPECT_EQ(data.cells(), 2U);
  EXPECT_EQ(integers(data.point_columns, "number"), (std::vector<std::int32_t>{0, 1}));
  EXPECT_EQ(integers(data.point_columns, "load"), (std::vector<std::int32_t>{0, 1}));
  EXPECT_EQ(vectors(data.point_columns, "force")[1], Vec3(0, 0, -5));
  EXPECT_EQ(vectors(data.point_columns, "moment")[0], Vec3(1, 0, 0));
  EXPECT_EQ(vectors(data.point_columns, "displacement")[1], Vec3(0, 0, 0.2));
  EXPECT_EQ(numbers(data.point_columns, "power"), (std::vector<double>{0.5, -0.5}));
}

TEST(SurfaceDataset, HasUnitNormalsThatPointOutwards) {
  const Dataset data = SyntheticRun().surface({});
  const Vec3 center(0, 0, 0.24);
  const Points normals = vectors(data.point_columns, "normal");
  for (std::size_t i = 0; i < normals.size(); ++i) {
    EXPECT_NEAR(normals[i].norm(), 1, rounding);
    EXPECT_GT(normals[i].dot(data.points[i] - center), 0);
  }
}

TEST(BonesDataset, HasTheBoneAndThreeAxesAQuarterOfItsLength) {
  const SyntheticRun run;
  const Dataset data = run.bones({SyntheticRun::half_turn, 0});
  ASSERT_EQ(data.cells(), 4 * run.skeleton.size());
  const auto& axis = integers(data.cell_columns, "axis");
  for (std::size_t cell = 0; cell < data.cells(); ++cell) {
    const Vec3 displacement =
        data.points[data.connectivity[2 * cell + 1]] - data.points[data.connectivity[2 * cell]];
    EXPECT_EQ(axis[cell], static_cast<int>(cell % 4));
    EXPECT_NEAR(displacement.norm(), axis[cell] == 0 ? 0.24 : 0.06, rounding);
  }
  EXPECT_EQ(integers(data.cell_columns, "parent"),
            (std::vector<std::int32_t>{-1, -1, -1, -1, 0, 0, 0, 0}));
}

TEST(BonesDataset, BendsTheSecondBoneOnTheHeadOfTheFirst) {
  const Dataset data = SyntheticRun().bones({SyntheticRun::half_turn, 0});
  EXPECT_NEAR((data.points[5] - Vec3(0, 0, 0.24)).norm(), 0, rounding);
  EXPECT_NEAR((data.points[6] - Vec3(0.24, 0, 0.24)).norm(), 0, rounding);
}

TEST(FramesDataset, OrientationTurnsTheSceneAxesIntoTheBones) {
  const Dataset data = SyntheticRun().frames({0.7, 0});
  const Column* orientation = find(data.point_columns, "orientation");
  ASSERT_TRUE(orientation);
  const auto& q = std::get<std::vector<double>>(orientation->values);
  const char* axes[3] = {"axis_x", "axis_y", "axis_z"};
  for (std::size_t b = 0; b < data.points.size(); ++b) {
    const Quat turn(q[4 * b], q[4 * b + 1], q[4 * b + 2], q[4 * b + 3]);
    EXPECT_GE(turn.w(), 0);
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR((turn * Vec3::Unit(k) - vectors(data.point_columns, axes[k])[b]).norm(), 0,
                  rounding);
  }
}

TEST(FramesDataset, GivesTheTwistInDegrees) {
  const Dataset data = SyntheticRun().frames({SyntheticRun::half_turn, 0});
  EXPECT_NEAR(numbers(data.point_columns, "twist")[1], 30, 1e-12);
}

}  // namespace sinew::frames_test

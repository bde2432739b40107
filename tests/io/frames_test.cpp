// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/frames.h>

#include <gtest/gtest.h>

#include "synthetic_run.h"

namespace sinew::frames_test {

constexpr double rounding = 1e-14;

TEST(ParticlesDataset, PutsShuffledParticlesIntoTheWrittenOrder) {
  Particles now = particles_at({{2, 0, 0}, {0, 0, 0}, {1, 0, 0}}, 0.5, 1);
  now.id = {2, 0, 1};
  now.u = {20, 0, 10};
  const Points rest = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  const Points force = {{0, 2, 0}, {0, 0, 0}, {0, 1, 0}};
  const std::vector<std::int32_t> bone = {5, 6, 7}, neighbors = {12, 10, 11};
  const std::vector<double> weight = {1, 0.5, 0.25};
  const Dataset data =
      particles_dataset({now, rest, bone, force, force, force, neighbors, {}, weight}, {3, 4});
  EXPECT_EQ(data.points, (Points{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}));
  EXPECT_EQ(vectors(data.point_columns, "velocity"), (Points{{0, 0, 0}, {10, 0, 0}, {20, 0, 0}}));
  EXPECT_EQ(vectors(data.point_columns, "force_bone"), (Points{{0, 0, 0}, {0, 1, 0}, {0, 2, 0}}));
  EXPECT_EQ(vectors(data.point_columns, "force"), (Points{{0, 0, 0}, {0, 3, 0}, {0, 6, 0}}));
  EXPECT_EQ(integers(data.point_columns, "neighbors"), (std::vector<std::int32_t>{10, 11, 12}));
  EXPECT_EQ(integers(data.point_columns, "bone"), bone);
  EXPECT_EQ(numbers(data.point_columns, "weight"), weight);
  EXPECT_EQ(integers(data.point_columns, "id"), (std::vector<std::int32_t>{0, 1, 2}));
  EXPECT_EQ(data.time, 3);
  EXPECT_EQ(data.cycle, 4);
}

TEST(ParticlesDataset, AddsTheForceOfTheWorldWhereThereIsOne) {
  const Particles now = particles_at({{0, 0, 0}}, 0.5, 1);
  const Points rest(1, Vec3::Zero()), force = {{1, 0, 0}}, world = {{0, 5, 0}};
  const std::vector<std::int32_t> zero(1, 0);
  const std::vector<double> one = {1};
  const Dataset with =
      particles_dataset({now, rest, zero, force, force, force, zero, {}, one, world}, {});
  EXPECT_EQ(vectors(with.point_columns, "force"), (Points{{3, 5, 0}}));
  EXPECT_EQ(vectors(with.point_columns, "force_world"), world);
  const Dataset without =
      particles_dataset({now, rest, zero, force, force, force, zero, {}, one}, {});
  EXPECT_EQ(vectors(without.point_columns, "force"), (Points{{3, 0, 0}}));
  EXPECT_EQ(without.point_columns.size() + 1, with.point_columns.size());
}

TEST(ParticlesDataset, TellsOfBrokenBondsWhereThereAreBonds) {
  Particles now = particles_at({{0, 0, 0}, {1, 0, 0}}, 0.5, 1);
  now.id = {1, 0};
  const Points two(2, Vec3::Zero());
  const std::vector<std::int32_t> zeros(2, 0), broken = {3, 5};
  const std::vector<double> ones(2, 1);
  const Dataset data =
      particles_dataset({now, two, zeros, two, two, two, zeros, {}, ones, {}, broken}, {});
  EXPECT_EQ(integers(data.point_columns, "broken_bonds"), (std::vector<std::int32_t>{5, 3}));
}

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

TEST(ParticlesDataset, TakesTheDisplacementInDouble) {
  const Points rest = {{1000, 0, 0}};
  const Particles now = particles_at({{1000 + 1e-9, 0, 0}}, 0.5, 1);
  const Points force(1, Vec3::Zero());
  const std::vector<std::int32_t> zero(1, 0);
  const Dataset data = particles_dataset(
      {now, rest, zero, force, force, force, zero, {}, std::vector<double>{1}}, {});
  EXPECT_NEAR(vectors(data.point_columns, "displacement")[0].x(), 1e-9, 1e-12);
}

TEST(ParticlesDataset, CarriesTheEnergies) {
  const Dataset data = SyntheticRun().particles({0.5, 7});
  EXPECT_EQ(numbers(data.field_columns, "kinetic_energy"), std::vector<double>{0.5});
  EXPECT_EQ(numbers(data.field_columns, "dissipation"), std::vector<double>{6});
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

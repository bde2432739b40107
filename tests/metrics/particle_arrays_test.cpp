// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/particle_values.h>

#include <gtest/gtest.h>

#include <sinew/core/arrays.h>
#include <sinew/core/error.h>
#include "metrics/world.h"

namespace sinew::test::particle_arrays_test {

constexpr double exact = 1e-12;

std::vector<double> values_of(const RestBody& body, const FrameState& state, const char* name) {
  const std::vector<std::string_view> names{name};
  const auto columns = particle_arrays(body, state, names);
  EXPECT_EQ(columns.at(0).name, name);
  return std::get<std::vector<double>>(columns[0].values);
}

Map affine(const Mat3& F) {
  return [F](const Vec3& point) -> Vec3 { return F * point; };
}

/// XX YY ZZ XY YZ XZ
std::array<double, 6> in_order(const Mat3& T) {
  return {T(0, 0), T(1, 1), T(2, 2), T(0, 1), T(1, 2), T(0, 2)};
}

template <std::size_t n>
void expect_everywhere(const std::vector<double>& values, const std::array<double, n>& expected,
                       double tolerance = exact) {
  ASSERT_EQ(values.size() % n, 0u);
  for (std::size_t i = 0; i < values.size(); ++i)
    ASSERT_NEAR(values[i], expected[i % n], tolerance) << "component " << i % n;
}

const Mat3 skewed = (Mat3() << 1.1, 0.2, 0.05, -0.1, 0.9, 0.03, 0.02, 0.07, 1.2).finished();

TEST(ParticleArrays, TheGradientStandsRowByRow) {
  const RestBody body = rest_body(box_input());
  expect_everywhere<9>(values_of(body, moved(body, affine(skewed)), "F"),
                       {1.1, 0.2, 0.05, -0.1, 0.9, 0.03, 0.02, 0.07, 1.2});
}

TEST(ParticleArrays, StrainsOfAnAffineMotionAreItsTensorsInParaViewsOrder) {
  const RestBody body = rest_body(box_input());
  const FrameState state = moved(body, affine(skewed));
  const Mat3 C = skewed.transpose() * skewed;
  expect_everywhere(values_of(body, state, "strain"), in_order((C - Mat3::Identity()) / 2));
  // A turn after a stretch along known directions has a known logarithm.
  const Mat3 directions = turned(33, {1, 2, -1});
  const Vec3 stretch(1.3, 1.05, 0.8);
  const Mat3 U = directions * stretch.asDiagonal() * directions.transpose();
  const Vec3 logs = stretch.array().log();
  const Mat3 H = directions * logs.asDiagonal() * directions.transpose();
  const FrameState turned_one = moved(body, affine(turned(70, {3, 1, 2}) * U));
  expect_everywhere(values_of(body, turned_one, "hencky_strain"), in_order(H));
  expect_everywhere<3>(values_of(body, turned_one, "stretch"), {1.3, 1.05, 0.8});
}

TEST(ParticleArrays, ARigidMotionHasNoStrainInAnyOfThem) {
  const RestBody body = rest_body(box_input());
  const FrameState state = moved_rigidly(body, turned(110, {1, -2, 3}), {1, 2, 3});
  for (const char* name : {"strain", "hencky_strain", "strain_eq", "D2min", "turnover"})
    expect_everywhere<1>(values_of(body, state, name), {0});
  expect_everywhere<1>(values_of(body, state, "pose_error"), {0});
  expect_everywhere<1>(values_of(body, state, "J"), {1});
}

TEST(ParticleArrays, ARigidMotionReadFromFloat32FilesHasNextToNone) {
  const RestBody body = rest_body(box_input());
  FrameState state = moved_rigidly(body, turned(110, {1, -2, 3}), {0.1, 0.2, 0.3});
  for (std::size_t i = 0; i < body.particles(); ++i) {
    const Vec3& rest = body.shape.points[i];
    const Eigen::Vector3f written = (state.positions[i] - rest).cast<float>();
    state.positions[i] = rest + written.cast<double>();
  }
  for (const char* name : {"strain", "hencky_strain", "strain_eq"})
    for (const double value : values_of(body, state, name)) EXPECT_LT(std::abs(value), 2e-5);
}

/// FCC of linear springs k = 1: C11 = sqrt 2, C12 = C44 = 1 / sqrt 2 (k / d0).
TEST(ParticleArrays, StressOfASmallStrainIsHookes) {
  RestInput input = box_input();
  static const ForceLaw law =
      law_without_bonds([](const Material&, double d) { return 2 * r - d; });
  obey(input, law);
  input.material.pair.b = 2.4 * r;
  const RestBody body = rest_body(input);
  const double e = 1e-6;
  const Mat3 strain = e * (Mat3() << 1, 0.4, -0.3, 0.4, -0.5, 0.7, -0.3, 0.7, 2).finished();
  const double unit = 1 / (2 * r), C12 = unit / std::sqrt(2.0), C11 = 2 * C12;
  const Mat3 stress =
      2 * C12 * strain + Mat3((C12 * strain.trace() + (C11 - 3 * C12) * strain.diagonal().array())
                                  .matrix()
                                  .asDiagonal());
  const auto found = values_of(body, moved(body, affine(Mat3::Identity() + strain)), "stress");
  const auto expected = in_order(stress);
  for (std::size_t i = 0; i < body.particles(); ++i)
    if (body.shape.neighbors.of(i).size() == 12) {
      for (std::size_t k = 0; k < 6; ++k)
        EXPECT_NEAR(found[6 * i + k], expected[k], 1e-4 * e * unit) << k;
    }
}

TEST(ParticleArrays, BondsPullWhereNoOtherForceReaches) {
  RestInput input = box_input();
  static const ForceLaw law = law_of_springs([](const Material&, double) { return 0.0; });
  obey(input, law);
  const RestBody body = rest_body(input);
  const double stretch = 1.5;  // d = 3 r is beyond b
  const auto found = values_of(body, moved(body, affine(stretch * Mat3::Identity())), "stress");
  // Twelve bonds of force 0.5 d0 at 1.5 d0: sum f r / (2 V) = 12 0.5 1.5 d0^2 / 3 / (2 V) each.
  const double d0 = 2 * r, V = std::pow(stretch, 3) * volume_per_particle(r),
               pressure = 12 * 0.5 * 1.5 * d0 * d0 / 3 / (2 * V);
  for (std::size_t i = 0; i < body.particles(); ++i)
    if (body.shape.neighbors.of(i).size() == 12) {
      for (std::size_t k = 0; k < 6; ++k)
        EXPECT_NEAR(found[6 * i + k], k < 3 ? pressure : 0, 1e-9 * pressure);
    }
}

/// Pulled to twice its length without getting thinner: the force on a face that keeps its area.
TEST(ParticleArrays, StressIsForceOverThePresentArea) {
  RestInput input = box_input();
  static const ForceLaw law = law_of_springs([](const Material&, double) { return 0.0; });
  obey(input, law);
  const RestBody body = rest_body(input);
  const double d0 = 2 * r, squeeze = 0.8;
  const Mat3 F = Vec3(squeeze, squeeze, 1).asDiagonal();
  const auto found = values_of(body, moved(body, affine(F)), "stress"),
             kirchhoff = values_of(body, moved(body, affine(F)), "stress_kirchhoff");
  // Across a face normal to x, of area d0^2 per particle and layer at rest, four bonds at 45
  // degrees in planes xy (two) and xz (two) act; those of xy keep their direction.
  const double x = d0 / std::sqrt(2.0), area = squeeze * d0 * d0;
  const double in_xy = (squeeze - 1) * d0 / std::sqrt(2.0) * 2;
  const double long_xz = x * std::sqrt(squeeze * squeeze + 1);
  const double in_xz = (long_xz - d0) * squeeze * x / long_xz * 2;
  for (std::size_t i = 0; i < body.particles(); ++i)
    if (body.shape.neighbors.of(i).size() == 12) {
      EXPECT_NEAR(found[6 * i], (in_xy + in_xz) / area, 1e-9 / d0);
      EXPECT_NEAR(kirchhoff[6 * i], found[6 * i] * F.determinant(), 1e-9 / d0);
    }
}

TEST(ParticleArrays, WhatIsCrushedFlatHasNoStress) {
  RestInput input = box_input();
  static const ForceLaw law = law_without_bonds([](const Material&, double) { return 1.0; });
  obey(input, law);
  const RestBody body = rest_body(input);
  const auto flat = moved(body, affine(Vec3(1, 1, 0.04).asDiagonal()));
  for (const double value : values_of(body, flat, "stress")) EXPECT_TRUE(std::isnan(value));
  for (const double value : values_of(body, flat, "von_mises")) EXPECT_TRUE(std::isnan(value));
  for (const double value : values_of(body, flat, "stress_kirchhoff"))
    EXPECT_FALSE(std::isnan(value));
}

TEST(ParticleArrays, VolumesThatAreKeptPressBack) {
  RestInput input = box_input();
  static const ForceLaw law = law_without_bonds([](const Material&, double) { return 0.0; });
  obey(input, law);
  keep_volumes(input, 1000);
  const RestBody body = rest_body(input);
  const double J = std::pow(0.9, 3);
  const auto found = values_of(body, moved(body, affine(0.9 * Mat3::Identity())), "stress");
  for (std::size_t i = 0; i < body.particles(); ++i)
    if (body.shape.neighbors.of(i).size() == 12) {  // w = 1 within
      for (std::size_t k = 0; k < 6; ++k)
        EXPECT_NEAR(found[6 * i + k], k < 3 ? 1000 * (J - 1) : 0, 1e-9);
    }
}

TEST(ParticleArrays, WhatIsNotKnownIsNotANumber) {
  RestInput input = box_input();
  input.positions = {{0, 0, h}, {2 * r, 0, h}};
  input.bone = {-1, 0};
  const RestBody body = rest_body(input);
  const auto columns = particle_arrays(body, at_rest(body), measured_arrays());
  ASSERT_EQ(columns.size(), measured_arrays().size());
  for (const Column& column : columns) {
    if (column.name == "inverted" || column.name == "surface_layer") continue;
    const auto& values = std::get<std::vector<double>>(column.values);
    EXPECT_EQ(values.size(), 2u * static_cast<std::size_t>(column.components)) << column.name;
    EXPECT_EQ(std::isnan(values[0]), column.name != "turnover") << column.name;
  }
}

TEST(ParticleValues, APairThatPartsIsLostAndOneThatMeetsIsGained) {
  RestInput input = box_input();
  input.positions = {{0, 0, h}, {2 * r, 0, h}, {6 * r, 0, h}, {8 * r, 0, h}};
  input.bone = {0, 0, 0, 0};
  const RestBody body = rest_body(input);
  FrameState state = at_rest(body);
  state.positions[0].x() -= 2 * r;  // leaves its only neighbor
  state.positions[2].x() -= 2 * r;  // leaves one, and meets particle 1
  const ParticleValues values = particle_values(body, state);
  EXPECT_EQ(values.lost, (std::vector<double>{1, 1, 1, 1}));
  EXPECT_EQ(values.gained, (std::vector<double>{0, 1, 1, 0}));
  EXPECT_EQ(values.turnover, (std::vector<double>{1, 2, 2, 1}));
}

TEST(ParticleValues, PullingHalvesApartTurnsOverAThirdOfAnInnerPlane) {
  const RestBody body = rest_body(box_input());
  const FrameState state = moved(body, [](const Vec3& p) -> Vec3 {
    return p.z() > half_length ? Vec3(p + b * Vec3::UnitZ()) : p;
  });
  const auto turnover = values_of(body, state, "turnover");
  int inner = 0;
  for (std::size_t i = 0; i < body.particles(); ++i) {
    const int plane = plane_of(body.shape.points[i]);
    const bool at_cut = plane == along / 2 - 1 || plane == along / 2;
    if (!at_cut) {
      EXPECT_EQ(turnover[i], 0);
    }
    if (!at_cut || body.shape.neighbors.of(i).size() < 12) continue;
    EXPECT_NEAR(turnover[i], 4.0 / 12, exact);  // of twelve, four lie across
    ++inner;
  }
  EXPECT_GT(inner, 4);
}

}  // namespace sinew::test::particle_arrays_test

// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/slices.h>

#include <gtest/gtest.h>

#include "metrics/world.h"

namespace sinew::test::slices_test {

constexpr double exact = 1e-9;  // degrees

TEST(Slices, AreTheHalfPlanesOfALatticeAlongTheBones) {
  const RestBody body = rest_body(box_input());
  ASSERT_EQ(body.slices.all.size(), static_cast<std::size_t>(along));
  EXPECT_EQ(body.slices.neighbors.size(), static_cast<std::size_t>(along - 1));
  for (int k = 0; k < along; ++k)
    for (const auto i : body.slices.all[k].particles) EXPECT_EQ(plane_of(body.shape.points[i]), k);
}

TEST(Slices, RunOnFromBoneToBoneWithinAThousandthOfALine) {
  for (const double aside : {0.9e-3, 1.1e-3}) {
    RestInput input = box_input();
    input.skeleton.bones[1].rest.origin.x() += aside * input.skeleton.bones[1].length;
    const std::size_t joined = rest_body(input).slices.neighbors.size();
    EXPECT_EQ(joined, static_cast<std::size_t>(aside < 1e-3 ? along - 1 : along - 2));
  }
}

TEST(Slices, UniformTwistTurnsEverySliceByTheSameStep) {
  const RestBody body = rest_body(box_input());
  const double per_plane = 4.5;
  const auto state = moved(body, twisted([&](double z) { return per_plane * z / h; }));
  EXPECT_NEAR(measure(body, state).twist_jump_max, per_plane, exact);
}

TEST(Slices, TheTipTurnsAsItsTwoHalfPlanesDo) {
  const RestBody body = rest_body(box_input());
  const double from = (along - 2) * h;
  const auto state = moved(body, twisted([&](double z) { return z > from ? 42 : 90 * z; }));
  EXPECT_NEAR(measure(body, state).tip_angle, 42, exact);
}

TEST(Slices, ACutShowsItsWholeAngleInOneStep) {
  const RestBody body = rest_body(box_input());
  const auto state = moved(body, twisted([](double z) { return z > half_length ? 90 : 0; }));
  const FrameMetrics m = measure(body, state);
  EXPECT_NEAR(m.twist_jump_max, 90, exact);  // across the joint from bone to bone
  EXPECT_NEAR(m.tip_angle, 90, exact);
}

TEST(Slices, TwistIsThatAboutTheBodyWhereverItHasTurned) {
  const RestBody body = rest_body(box_input());
  FrameState state = moved(body, twisted([](double z) { return 3 * z / h; }));
  const Mat3 turn = turned(120, {1, -1, 0.5});
  state.positions = mapped(state.positions, [&](const Vec3& p) -> Vec3 { return turn * p; });
  EXPECT_NEAR(measure(body, state).twist_jump_max, 3, exact);
}

TEST(Slices, BendingIsNoTwist) {
  const RestBody body = rest_body(box_input());
  const double curvature = radians(90) / (2 * half_length);  // a quarter circle about y
  const auto state = moved(body, [&](const Vec3& p) {
    const double angle = curvature * p.z(), radius = 1 / curvature - p.x();
    return Vec3(1 / curvature - radius * std::cos(angle), p.y(), radius * std::sin(angle));
  });
  EXPECT_NEAR(measure(body, state).twist_jump_max, 0, 1e-5);
}

TEST(Slices, EndAtABendOfTheSkeleton) {
  RestInput input = box_input();
  input.skeleton.bones[1].rest.rotation = turned(30, Vec3::UnitX()) * upright();
  const RestBody body = rest_body(input);
  const auto state = moved(body, twisted([](double z) { return z > half_length ? 90 : 0; }));
  EXPECT_LT(measure(body, state).twist_jump_max, 89);
}

TEST(Slices, NeedFourParticlesThatAreNotInALine) {
  RestInput input = box_input();
  input.positions.clear();
  for (int k = 0; k < along; ++k)
    for (int i = 0; i < 4; ++i) input.positions.push_back(h * Vec3(i, 0, k + 0.5));
  input.bone.assign(input.positions.size(), 0);
  EXPECT_TRUE(rest_body(input).slices.all.empty());
  for (std::size_t i = 0; i < input.positions.size(); i += 4) input.positions[i].y() += h;
  EXPECT_EQ(rest_body(input).slices.all.size(), static_cast<std::size_t>(along));
  input.positions.resize(3);
  input.bone.resize(3);
  EXPECT_TRUE(rest_body(input).slices.all.empty());
}

}  // namespace sinew::test::slices_test

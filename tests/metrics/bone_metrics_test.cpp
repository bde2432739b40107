// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/bone_metrics.h>

#include <gtest/gtest.h>

#include "metrics/world.h"

namespace sinew::test::bone_metrics_test {

std::vector<BoneMetrics> bones_of(const RestBody& body, const FrameState& state) {
  return measure_bones(body, state, particle_values(body, state));
}

TEST(BoneMetrics, ARigidMotionIsFollowedByAll) {
  const RestBody body = rest_body(box_input());
  const auto bones = bones_of(body, moved_rigidly(body, turned(64, {1, -1, 2}), {1, 2, 3}));
  ASSERT_EQ(bones.size(), 2u);
  EXPECT_EQ(bones[0].followers + bones[1].followers, static_cast<double>(body.particles()));
  for (const BoneMetrics& bone : bones)
    for (const double zero : {bone.adherence_rms, bone.adherence_95, bone.adherence_max,
                              bone.radial_mean, bone.pose_error_max, bone.twist_rms})
      EXPECT_NEAR(zero, 0, 1e-10);
}

TEST(BoneMetrics, ABoneThatTurnsAloneLeavesItsFleshBehindByThatAngle) {
  const RestBody body = rest_body(box_input());
  FrameState state = at_rest(body);
  state.bones[1].rotation = turned(20, Vec3::UnitZ()) * state.bones[1].rotation;
  const auto bones = bones_of(body, state);
  EXPECT_NEAR(bones[0].twist_rms, 0, 1e-10);
  EXPECT_NEAR(bones[1].twist_rms, 20, 1e-10);
  EXPECT_NEAR(bones[1].twist_mean, -20, 1e-10);
  EXPECT_NEAR(bones[1].adherence_max, 0, 1e-12);
}

TEST(BoneMetrics, TheAngleOfALimbIsTheSameAnywhere) {
  for (const double far : {0.0, 1e3, 1e5, 1e7}) {
    RestInput input = moved_to({far * 2 * half_length, 0, 0}, box_input());
    const RestBody body = rest_body(input);
    FrameState state = at_rest(body);
    state.bones[1].rotation = turned(20, {1, 2, 3}) * state.bones[1].rotation;
    EXPECT_NEAR(bones_of(body, state)[1].turn_error, 20, 20 * std::max(1e-10, 1e-10 * far)) << far;
  }
}

TEST(BoneMetrics, SwellingIsTheMeanWayOutwards) {
  const RestBody body = rest_body(box_input());
  const double swell = 0.1;
  const auto bones = bones_of(body, moved(body, [&](const Vec3& p) -> Vec3 {
                                return {(1 + swell) * p.x(), (1 + swell) * p.y(), p.z()};
                              }));
  for (std::size_t b_ = 0; b_ < 2; ++b_) {
    double mean = 0, largest = 0;
    for (const Bound& bound : body.bound)
      if (bound.bone == static_cast<int>(b_)) {
        mean += swell * bound.distance / bones[b_].followers;
        largest = std::max(largest, swell * bound.distance);
      }
    EXPECT_NEAR(bones[b_].radial_mean, mean, 1e-12);
    EXPECT_NEAR(bones[b_].adherence_max, largest, 1e-12);
    EXPECT_GT(bones[b_].adherence_joint_rms, 0);
  }
}

TEST(BoneMetrics, TheFileHasARowPerFrameAndBone) {
  const RestBody body = rest_body(box_input());
  const std::string text = bone_metrics_csv(bones_of(body, at_rest(body)));
  EXPECT_EQ(text.substr(0, 20), "time,bone,followers,");
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3);
}

}  // namespace sinew::test::bone_metrics_test

// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "metrics/world.h"

namespace sinew::test::adherence_test {

constexpr double exact = 1e-12;

double distance_from_axis(const Vec3& p) { return std::hypot(p.x(), p.y()); }

TEST(Adherence, RadialInflationLeavesTheBoneByItsFactor) {
  const RestBody body = rest_body(box_input());
  const double factor = 1.15;
  const FrameMetrics m = measure(body, moved(body, [&](const Vec3& p) {
                                   return Vec3(factor * p.x(), factor * p.y(), p.z());
                                 }));
  Statistics radial;
  for (const Vec3& p : body.shape.points) radial.add(distance_from_axis(p));
  EXPECT_NEAR(m.adherence_rms, (factor - 1) * radial.rms(), exact);
  EXPECT_NEAR(m.adherence_max, (factor - 1) * radial.max(), exact);
  EXPECT_NEAR(m.pose_error_rms, (factor - 1) * radial.rms(), exact);
}

TEST(Adherence, TurningAboutTheBoneKeepsTheDistanceButNotThePose) {
  const RestBody body = rest_body(box_input());
  const FrameMetrics m = measure(body, moved(body, twisted([](double) { return 60; })));
  Statistics radial;
  for (const Vec3& p : body.shape.points) radial.add(distance_from_axis(p));
  EXPECT_NEAR(m.adherence_max, 0, exact);
  EXPECT_NEAR(m.pose_error_rms, radial.rms(), exact);  // the chord of 60 degrees is the radius
  EXPECT_NEAR(m.pose_error_max, radial.max(), exact);
}

TEST(Adherence, FollowsTheBoneOfEachParticle) {
  const RestBody body = rest_body(box_input());
  FrameState state = at_rest(body);
  state.bones[1].origin += Vec3(0.03, 0, 0.04);  // the upper half stays behind its bone
  const double upper = static_cast<double>(std::count_if(
      body.bound.begin(), body.bound.end(), [](const Bound& bound) { return bound.bone == 1; }));
  EXPECT_NEAR(measure(body, state).pose_error_rms,
              0.05 * std::sqrt(upper / static_cast<double>(body.particles())), exact);
  EXPECT_NEAR(measure(body, state).pose_error_max, 0.05, exact);
}

TEST(Adherence, ParticlesWithoutABoneDoNotCount) {
  RestInput input = box_input();
  for (std::size_t i = 0; i < input.bone.size(); ++i)
    if (distance_from_axis(input.positions[i]) > h) input.bone[i] = -1;
  const RestBody body = rest_body(input);
  const FrameMetrics m = measure(body, moved(body, [](const Vec3& p) -> Vec3 {
                                   return distance_from_axis(p) > h ? Vec3(2 * p) : p;
                                 }));
  EXPECT_EQ(m.adherence_max, 0);
  EXPECT_EQ(m.pose_error_max, 0);
  EXPECT_GT(m.displacement_max, h);
}

/// Half the width: every half-plane pair of the box holds 25 sites of V0 = 4 sqrt(2) r^3 each.
double joint_zone() {
  const double particles_per_half = across * across * along / 4.0;
  return std::sqrt(particles_per_half * volume_per_particle(r) / half_length) / 2;
}

TEST(Adherence, FarIsBeyondHalfAWidthFromTheJointAlongTheBones) {
  const RestBody body = rest_body(box_input());
  EXPECT_NEAR(joint_zone(), across * h / 2, exact);
  for (const Bound& bound : body.bound) {
    const double z = body.shape.points[bound.particle].z();
    EXPECT_EQ(bound.far, std::abs(z - half_length) > joint_zone()) << z;
  }
}

TEST(Adherence, ErrorsAtTheJointStayOutOfTheFarField) {
  const RestBody body = rest_body(box_input());
  const FrameMetrics m = measure(body, moved(body, [](const Vec3& p) -> Vec3 {
                                   const bool near = std::abs(p.z() - half_length) < joint_zone();
                                   return near ? Vec3(p + r * Vec3::UnitX()) : p;
                                 }));
  EXPECT_NEAR(m.pose_error_max, r, exact);
  EXPECT_EQ(m.pose_error_far_rms, 0);
}

}  // namespace sinew::test::adherence_test

// SPDX-License-Identifier: GPL-3.0-or-later
// Sections across the bones of a square prism, moved by linear blends as skinning moves it: each
// ring's area has a closed form.
#include <sinew/metrics/sections.h>

#include <gtest/gtest.h>

#include <sinew/metrics/bone_metrics.h>
#include "metrics/world.h"

namespace sinew::test::sections_test {

constexpr double exact = 1e-12;
constexpr double half = 0.25;   // of the prism's width, m
constexpr double length = 1.0;  // of each of its two bones; layers of points lie on their sections
constexpr int layers = 2 * sections_per_bone;

/// Rings of four corners, closed by two caps.
Triangles prism() {
  Triangles surface;
  for (int k = 0; k <= layers; ++k)
    for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
      surface.points.push_back({half * x, half * y, length * k / sections_per_bone});
  for (int k = 0; k < layers; ++k)
    for (int i = 0; i < 4; ++i) {
      const int a = 4 * k + i, b_ = 4 * k + (i + 1) % 4;
      surface.faces.push_back({a, b_, b_ + 4});
      surface.faces.push_back({a, b_ + 4, a + 4});
    }
  const int top = 4 * layers;
  surface.faces.insert(surface.faces.end(),
                       {{0, 2, 1}, {0, 3, 2}, {top, top + 1, top + 2}, {top, top + 2, top + 3}});
  return surface;
}

std::vector<Bone> two_bones() {
  return {bone_at("lower", -1, 0, length), bone_at("upper", 0, length, 2 * length)};
}

std::vector<Section> sections_of(const Triangles& surface) {
  return make_sections(surface, two_bones(),
                       [](const Vec3& place) { return std::abs(place.z() - length) <= half; });
}

/// The upper bone's weight, linear over a zone of its half width on either side of the joint.
double upper_weight(double z, double zone = half) {
  return std::clamp((z - length) / (2 * zone) + 0.5, 0.0, 1.0);
}

Map blended(const Mat3& turn, double zone = half, double joint = length) {
  return [=](const Vec3& p) -> Vec3 {
    const Vec3 at(0, 0, joint);
    const double w = std::clamp((p.z() - joint) / (2 * zone) + 0.5, 0.0, 1.0);
    return (1 - w) * p + w * (at + turn * (p - at));
  };
}

/// |(1 - w) + w e^(it)|^2: what a blend leaves of a square length.
double kept(double w, double degrees_) {
  return 1 - 2 * w * (1 - w) * (1 - std::cos(radians(degrees_)));
}

TEST(Sections, OfAPrismAreItsSquareAtEveryStepOfBothBones) {
  const auto sections = sections_of(prism());
  ASSERT_EQ(sections.size(), 2u * (sections_per_bone + 1) - 1);  // none beyond the lower cap
  for (const Section& section : sections) {
    EXPECT_NEAR(section.area, 4 * half * half, exact);
    EXPECT_EQ(section.joint, std::abs(section.along * length - (section.bone == 0)) <= half);
  }
}

TEST(Sections, AreTheSameFarAway) {
  for (const double far : {1e3, 1e5, 1e7}) {
    Triangles surface = prism();
    std::vector<Bone> bones = two_bones();
    const Vec3 at(std::round(far), 0, 0);
    for (Vec3& point : surface.points) point += at;
    for (Bone& bone : bones) {
      bone.rest.origin += at;
      bone.rest.rotation = turned(1e-15, {1, 2, 3}) * bone.rest.rotation;  // rounding
    }
    const auto sections = make_sections(surface, bones, [](const Vec3&) { return false; });
    ASSERT_EQ(sections.size(), 2u * (sections_per_bone + 1) - 1) << far;
    for (const Section& section : sections) EXPECT_NEAR(section.area, 4 * half * half, 1e-15 * far);
  }
}

TEST(Sections, ATwistByLinearBlendPinchesThemAsTheSquareOfTheCosine) {
  const Triangles surface = prism();
  for (const double angle : {90.0, 180.0}) {
    const Points now = mapped(surface.points, blended(turned(angle, Vec3::UnitZ())));
    for (const Section& section : sections_of(surface)) {
      const double z = (section.bone + section.along) * length;
      EXPECT_NEAR(area_of(section, now) / section.area, kept(upper_weight(z), angle), exact);
      if (section.bone == 1 && section.along == 0) {
        EXPECT_NEAR(area_of(section, now) / section.area, std::pow(std::cos(radians(angle / 2)), 2),
                    exact);
      }
    }
  }
}

TEST(Sections, ABendByLinearBlendNarrowsThemInOneDirection) {
  const Triangles surface = prism();
  const Points now = mapped(surface.points, blended(turned(90, Vec3::UnitY())));
  for (const Section& section : sections_of(surface)) {
    const double z = (section.bone + section.along) * length;
    EXPECT_NEAR(area_of(section, now) / section.area, std::sqrt(kept(upper_weight(z), 90)), exact);
  }
}

TEST(Sections, ARigidMotionKeepsThem) {
  const Triangles surface = prism();
  const Mat3 turn = turned(81, {1, 2, 3});
  const Points now =
      mapped(surface.points, [&](const Vec3& p) -> Vec3 { return turn * p + Vec3(1, -2, 3); });
  for (const Section& section : sections_of(surface))
    EXPECT_NEAR(area_of(section, now) / section.area, 1, exact);
}

TEST(Sections, LeaveOutLimbsThatTheirBonesDoNotRunIn) {
  Triangles two = prism();
  const auto points = static_cast<int>(two.points.size());
  const Triangles other = prism();
  for (const Vec3& p : other.points) two.points.push_back(p + Vec3(5 * half, 0, 0));
  for (const auto& [a, b_, c] : other.faces)
    two.faces.push_back({a + points, b_ + points, c + points});
  const auto sections = sections_of(two);
  EXPECT_EQ(sections.size(), sections_of(prism()).size());
  for (const Section& section : sections) EXPECT_NEAR(section.area, 4 * half * half, exact);
}

TEST(Sections, GiveTheFrameItsIndices) {
  RestInput input = box_input();
  input.surface = prism();
  for (Vec3& point : input.surface.points) point *= half_length;  // as long as the bones
  const RestBody body = rest_body(input);
  FrameState state = at_rest(body);
  const FrameMetrics rest = measure(body, state);
  EXPECT_NEAR(rest.candy_wrapper, 0, exact);
  EXPECT_NEAR(rest.bulge, 0, exact);
  state.surface_points = mapped(
      state.surface_points, blended(turned(90, Vec3::UnitZ()), half * half_length, half_length));
  EXPECT_NEAR(measure(body, state).candy_wrapper, 0.5, exact);
  state.surface_points = mapped(body.surface.points, [](const Vec3& p) -> Vec3 {
    return {1.1 * p.x(), 1.1 * p.y(), p.z()};
  });
  EXPECT_NEAR(measure(body, state).bulge, 0.21, exact);
}

TEST(Sections, TheFileHasARowPerFrameAndSection) {
  const Triangles surface = prism();
  const auto sections = sections_of(surface);
  const std::string text = sections_csv(measure_sections(sections, surface.points, 0.5));
  EXPECT_EQ(text.substr(0, 16), "time,bone,along,");
  EXPECT_EQ(static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')),
            sections.size() + 1);
}

/// A body fine enough that sums over its particles are integrals, its joint in the middle.
RestInput fine_box() {
  constexpr int width = 21, planes = 84;
  RestInput input = box_input();
  input.positions = fcc_box(width, planes);
  const double side = width * h / 2, middle = planes * h / 2;
  input.surface = box_surface({-side, -side, 0}, {side, side, 2 * middle});
  input.skeleton.bones = {bone_at("lower", -1, 0, middle), bone_at("upper", 0, middle, 2 * middle)};
  input.bone.clear();
  for (const Vec3& point : input.positions) input.bone.push_back(point.z() > middle);
  return input;
}

/// Mean J of the joint zone's particles when the body is blended over just that zone.
double zone_volume(const RestBody& body, const Mat3& turn) {
  const double joint = body.bones[0].length, zone = 21 * h / 2;
  const FrameState state = moved(body, blended(turn, zone, joint));
  const auto bones = measure_bones(body, state, particle_values(body, state));
  return (bones[0].volume_joint_ratio + bones[1].volume_joint_ratio) / 2;
}

TEST(JointZone, LosesTheVolumeThatLinearBlendsLose) {
  const RestBody body = rest_body(fine_box());
  const auto lost = [](double degrees_) { return 1 - std::cos(radians(degrees_)); };
  const double coarse = 0.015;  // planes at the surface and the ends of the zone see half of it
  for (const double angle : {45.0, 90.0}) {
    EXPECT_NEAR(zone_volume(body, turned(angle, Vec3::UnitZ())), 1 - lost(angle) / 3, coarse);
    EXPECT_NEAR(zone_volume(body, turned(angle, Vec3::UnitY())), 1 - lost(angle) / 6, coarse);
  }
}

TEST(BoneMetrics, AStretchScalesTheVolumeOfEachBone) {
  const RestBody body = rest_body(box_input());
  const FrameState state = moved(body, [](const Vec3& p) -> Vec3 {
    return {p.x(), p.y(), 1.3 * p.z()};
  });
  for (const BoneMetrics& bone : measure_bones(body, state, particle_values(body, state))) {
    EXPECT_NEAR(bone.volume, 1.3 * volume_per_particle(r) * bone.followers, exact);
    for (const double ratio : {bone.volume_ratio, bone.volume_joint_ratio, bone.volume_far_ratio})
      EXPECT_NEAR(ratio, 1.3, exact);
  }
}

}  // namespace sinew::test::sections_test

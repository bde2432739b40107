// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/rig/skinning.h>

#include <gtest/gtest.h>

#include <sinew/core/triangles.h>
#include <sinew/scene/rig.h>

#include "support/world.h"

namespace sinew::skinning_test {

constexpr int slices = 200;
constexpr double width = 0.3;

/// The joint zone of a square prism of length 1 along z; weights pass from bone 0 to bone 1.
struct Prism {
  Triangles surface;
  BoneWeights weights;
  Skeleton skeleton;

  Prism() {
    Settings settings;
    settings.bones = {{"lower", "", Vec3(0, 0, -1), Vec3(0, 0, 0.5)},
                      {"upper", "lower", {}, Vec3(0, 0, 2)}};
    skeleton = skeleton_of(settings);
    weights.first.push_back(0);
    for (int k = 0; k <= slices; ++k)
      for (int corner = 0; corner < 4; ++corner) add(k, corner);
    for (int k = 0; k < slices; ++k)
      for (int side = 0; side < 4; ++side) add_side(4 * k + side, 4 * k + (side + 1) % 4, k + side);
    surface.faces.push_back({0, 2, 1});
    surface.faces.push_back({0, 3, 2});
    const int top = 4 * slices;
    surface.faces.push_back({top, top + 1, top + 2});
    surface.faces.push_back({top, top + 2, top + 3});
  }

  void add(int slice, int corner) {
    const double weight = static_cast<double>(slice) / slices;
    const double x = corner == 1 || corner == 2 ? width / 2 : -width / 2;
    surface.points.emplace_back(x, corner >= 2 ? width / 2 : -width / 2, weight);
    weights.weights.push_back({0, 1 - weight});
    weights.weights.push_back({1, weight});
    weights.first.push_back(static_cast<std::uint32_t>(weights.weights.size()));
  }

  /// Diagonals alternate, so that a twist bends as many inwards as outwards.
  void add_side(int a, int b, int parity) {
    if (parity % 2 == 0) {
      surface.faces.push_back({a, b, b + 4});
      surface.faces.push_back({a, b + 4, a + 4});
    } else {
      surface.faces.push_back({a, b, a + 4});
      surface.faces.push_back({b, b + 4, a + 4});
    }
  }

  Pose turned(const Vec3& axis, double angle) const {
    Pose pose = rest_pose(skeleton);
    pose[1].turn = test::turned(axis, angle);
    pose[1].frame.rotation = pose[1].turn * pose[1].frame.rotation;
    return pose;
  }

  Points linear(const Pose& pose) const {
    return linear_blend_skinned(surface.points, weights, skeleton, pose);
  }
  Points dual(const Pose& pose) const {
    return dual_quaternion_skinned(surface.points, weights, skeleton, pose);
  }
  /// Returns the fraction of the volume at rest.
  double volume_ratio(Points points) const {
    return volume({std::move(points), surface.faces}) / volume(surface);
  }
};

/// Area of the section in the middle as a fraction of that at rest.
double middle_section(const Points& points) {
  const int first = 4 * (slices / 2);
  const Vec3 diagonal = points[first + 2] - points[first];
  const Vec3 other = points[first + 3] - points[first + 1];
  return diagonal.cross(other).norm() / 2 / (width * width);
}

const double angles[] = {30, 60, 90, 120, 150, 180};
constexpr double discrete = 2e-4;  // of flat faces between slices

TEST(LinearBlendSkinning, LosesTheVolumeOfATwist) {
  const Prism prism;
  for (const double angle : angles) {
    const Points points = prism.linear(prism.turned(Vec3::UnitZ(), angle));
    const double c = std::cos(radians(angle)), half = std::cos(radians(angle) / 2);
    EXPECT_NEAR(prism.volume_ratio(points), 1 - (1 - c) / 3, discrete) << angle;
    EXPECT_NEAR(middle_section(points), half * half, 1e-12) << angle;
  }
}

TEST(LinearBlendSkinning, LosesTheVolumeOfABend) {
  const Prism prism;
  for (const double angle : angles)
    EXPECT_NEAR(prism.volume_ratio(prism.linear(prism.turned(Vec3::UnitY(), angle))),
                1 - (1 - std::cos(radians(angle))) / 6, discrete)
        << angle;
}

TEST(DualQuaternionSkinning, KeepsTheVolumeOfTwistsAndBends) {
  const Prism prism;
  for (const double angle : angles)
    for (const Vec3& axis : {Vec3(Vec3::UnitZ()), Vec3(Vec3::UnitY())}) {
      const Points points = prism.dual(prism.turned(axis, angle));
      EXPECT_NEAR(prism.volume_ratio(points), 1, discrete) << angle;
      EXPECT_NEAR(middle_section(points), 1, 1e-9) << angle;
    }
}

TEST(Skinning, OfOneBoneIsItsOwnMotion) {
  const Prism prism;
  Pose pose = prism.turned({1, 2, 3}, 200);
  pose[1].frame.origin += Vec3(0.3, -0.2, 0.1);
  pose[1].stretch = 1.3;
  const Points points = {{0.1, 0.2, 0.9}};
  const BoneWeights one{{0, 1}, {{1, 1}}};
  const Vec3 carried = pose[1].carried(points[0], prism.skeleton.bones[1]);
  EXPECT_LT((linear_blend_skinned(points, one, prism.skeleton, pose)[0] - carried).norm(), 1e-14);
  EXPECT_LT((dual_quaternion_skinned(points, one, prism.skeleton, pose)[0] - carried).norm(),
            1e-14);
}

TEST(Skinning, OfAllBonesMovingAsOneIsTheirMotion) {
  const Prism prism;
  Pose pose = prism.turned({1, 2, 3}, 100);
  pose[0].turn = pose[1].turn;
  pose[1].frame.origin = Vec3(1, 2, 3);
  pose[0].frame.origin = pose[1].carried(prism.skeleton.bones[0].head(), prism.skeleton.bones[1]);
  const Points linear = prism.linear(pose), dual = prism.dual(pose);
  for (std::size_t i = 0; i < linear.size(); ++i) {
    const Vec3 expected = pose[1].carried(prism.surface.points[i], prism.skeleton.bones[1]);
    EXPECT_LT((linear[i] - expected).norm(), 1e-14);
    EXPECT_LT((dual[i] - expected).norm(), 1e-14);
  }
}

TEST(Skinning, LeavesVerticesWithoutWeights) {
  const Prism prism;
  const Pose pose = prism.turned(Vec3::UnitX(), 90);
  const BoneWeights none{{0, 0}, {}};
  const Points points = {{1, 2, 3}};
  EXPECT_EQ(linear_blend_skinned(points, none, prism.skeleton, pose), points);
  EXPECT_EQ(dual_quaternion_skinned(points, none, prism.skeleton, pose), points);
}

}  // namespace sinew::skinning_test

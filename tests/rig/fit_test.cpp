// SPDX-License-Identifier: GPL-3.0-or-later
// A rig that was moved out of its mesh by a known placement comes back into it.
#include <gtest/gtest.h>

#include <sinew/core/options.h>
#include <sinew/core/triangles.h>
#include <sinew/rig/fit.h>

#include "support/expect_error.h"
#include "support/world.h"

namespace sinew::fit_test {

/// Twelve faces around the box of a frame, outward.
void add_box(const RigidFrame& frame, const Vec3& low, const Vec3& high, Triangles& surface) {
  const int first = static_cast<int>(surface.points.size());
  for (int corner = 0; corner < 8; ++corner)
    surface.points.push_back(frame.origin +
                             frame.rotation * Vec3((corner & 1) ? high.x() : low.x(),
                                                   (corner & 2) ? high.y() : low.y(),
                                                   (corner & 4) ? high.z() : low.z()));
  for (const auto& [a, b, c, d] : {std::array{0, 2, 3, 1},
                                   {4, 5, 7, 6},
                                   {0, 1, 5, 4},
                                   {2, 6, 7, 3},
                                   {0, 4, 6, 2},
                                   {1, 3, 7, 5}}) {
    surface.faces.push_back({first + a, first + b, first + c});
    surface.faces.push_back({first + a, first + c, first + d});
  }
}

/// A person in a T, upright along z and looking along x: feet and nose tell front from back.
Skeleton person() {
  const std::vector<BoneDefinition> bones = {
      {"spine", "", Vec3(0, 0, 0.9), Vec3(0, 0, 1.4)},
      {"head", "spine", {}, Vec3(0, 0, 1.7)},
      {"left arm", "spine", Vec3(0, 0.15, 1.4), Vec3(0, 0.75, 1.4)},
      {"right arm", "spine", Vec3(0, -0.15, 1.4), Vec3(0, -0.75, 1.4)},
      {"left leg", "spine", Vec3(0, 0.1, 0.9), Vec3(0, 0.12, 0.08)},
      {"right leg", "spine", Vec3(0, -0.1, 0.9), Vec3(0, -0.12, 0.08)},
      {"left foot", "left leg", {}, Vec3(0.2, 0.12, 0.03)},
      {"right foot", "right leg", {}, Vec3(0.2, -0.12, 0.03)}};
  return make_skeleton(bones);
}

/// A beam around each bone, thicker for the spine.
Triangles flesh(const Skeleton& skeleton) {
  Triangles surface;
  for (const Bone& bone : skeleton.bones) {
    const double half = bone.name == "spine" ? 0.13 : 0.05;
    add_box(bone.rest, Vec3(-0.02, -half, -half), Vec3(bone.length + 0.02, half, half), surface);
  }
  return surface;
}

/// The farthest that a bone's end is from where it belongs, m.
double farthest_apart(const Skeleton& one, const Skeleton& other) {
  double most = 0;
  for (std::size_t b = 0; b < one.size(); ++b)
    most = std::max({most, (one.bones[b].head() - other.bones[b].head()).norm(),
                     (one.bones[b].tail() - other.bones[b].tail()).norm()});
  return most;
}

Placement inverse(const Placement& placement) {
  return {1 / placement.scale, placement.turn.transpose(),
          placement.turn.transpose() * placement.offset / -placement.scale};
}

TEST(Fit, BringsARigBackIntoItsMeshFromAnyUnitAxisAndPlace) {
  const Skeleton there = person();
  const Triangles surface = flesh(there);
  EXPECT_GT(volume(surface), 0) << "outward";
  for (const Vec3& angles : {Vec3(0, 0, 0), Vec3(90, 0, 0), Vec3(90, 0, 90), Vec3(0, 180, 90),
                             Vec3(-90, 90, 0), Vec3(0, 0, 180)})
    for (const double scale : {1.0, 100.0, 0.03}) {
      const Placement out = {scale, rotation_of(angles), Vec3(3, -200, 17)};
      const Skeleton found = placed(placed(there, out), fit_to(surface, placed(there, out)));
      EXPECT_LT(farthest_apart(found, there), 0.07) << angles.transpose() << ", " << scale;
    }
}

TEST(Fit, FindsARigThatLiesObliquely) {
  const Skeleton there = person();
  const Placement out = {0.1, rotation_of({20, -35, 110}), Vec3(1, 1, 1)};
  const Skeleton found = placed(placed(there, out), fit_to(flesh(there), placed(there, out)));
  EXPECT_LT(farthest_apart(found, there), 0.1);
}

TEST(Fit, LeavesASymmetricRigUpright) {
  const std::vector<BoneDefinition> one = {{"one", "", Vec3(0, 0, 0), Vec3(0, 0, 1)}};
  const Skeleton rod = make_skeleton(one);
  const Placement fit = fit_to(flesh(rod), rod);
  EXPECT_EQ(fit.turn, Mat3::Identity());
  EXPECT_NEAR(fit.scale, 1, 0.1);
}

TEST(Fit, OptionsHoldBothPlacements) {
  SkeletonOptions before;
  before.scale = 0.01;
  before.up = Axis::y;
  before.rotation = Vec3(10, 20, 30);
  before.offset = Vec3(1, 2, 3);
  const Placement first = placement_of(before);
  const Placement then = {2, rotation_of({-40, 5, 90}), Vec3(-1, 0, 4)};
  const Placement both = placement_of(placed_again(before, then));
  const Vec3 point(5, -6, 7);
  EXPECT_LT((both(point) - then(first(point))).norm(), 1e-13);
  EXPECT_LT((first(inverse(first)(point)) - point).norm(), 1e-13);
}

TEST(Fit, RefusesAMeshOfNoSize) {
  test::expect_bad_input([] { fit_to({}, person()); }, {"no size", "; "});
  test::expect_bad_input([] { fit_to(flesh(person()), {}); },
                         {"no rig", "; ", "leave skeleton.fit out"});
}

TEST(Angles, AreThoseOfTheRotationAndExactInRightAngles) {
  for (const Vec3& angles : {Vec3(10, 20, 30), Vec3(-170, 89.9, 5), Vec3(0, 90, 0),
                             Vec3(33, -90, 0), Vec3(0, 0, 179), Vec3(-90, 0, 180)}) {
    const Mat3 turn = rotation_of(angles);
    EXPECT_LT((rotation_of(angles_of(turn)) - turn).norm(), 1e-12) << angles.transpose();
  }
  EXPECT_EQ(rotation_of({90, 0, 0}) * Vec3::UnitY(), Vec3::UnitZ());
  EXPECT_EQ(rotation_of({0, -270, 0}) * Vec3::UnitZ(), Vec3::UnitX());
  EXPECT_EQ(rotation_of({90, 0, 90}) * Vec3::UnitY(), Vec3::UnitZ());
  EXPECT_EQ(angles_of(rotation_of({0, 90, 180})), angles_of(rotation_of({-180, 90, 0})));
}

}  // namespace sinew::fit_test

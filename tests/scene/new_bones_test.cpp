// SPDX-License-Identifier: GPL-3.0-or-later
// Bones that a mesh gets without a rig: where its limbs are, however it lies.
#include <gtest/gtest.h>

#include <cmath>

#include <sinew/core/parallel.h>
#include <sinew/mesh/clean.h>
#include <sinew/mesh/refine.h>
#include <sinew/mesh/solids.h>
#include <sinew/mesh/winding.h>
#include <sinew/repair/curve_skeleton.h>
#include <sinew/rig/binding.h>
#include <sinew/rig/limbs.h>
#include <sinew/rig/motion.h>
#include "mesh/shapes.h"

namespace sinew::new_bones_test {

constexpr double radius = 0.01, arm = 0.3, half_width = 0.03;

/// A flat star with square arms along the directions 2 pi i / n.
Triangles star(int arms) {
  Triangles flat;
  flat.points.push_back(Vec3::Zero());
  const double hub = half_width / std::tan(pi / arms);
  for (int i = 0; i < arms; ++i) {
    const double turn = 2 * pi * i / arms;
    const Vec3 along(std::cos(turn), std::sin(turn), 0), across(-along.y(), along.x(), 0);
    flat.points.push_back(hub * along - half_width * across);
    flat.points.push_back(arm * along - half_width * across);
    flat.points.push_back(arm * along + half_width * across);
  }
  const int count = 3 * arms;
  for (int i = 0; i < count; ++i) flat.faces.push_back({0, 1 + i, 1 + (i + 1) % count});
  return refined(thickened(flat, 2 * half_width), 0.05);
}

std::vector<Limb> limbs(const Triangles& surface) { return limbs_of(curve_skeleton(surface)); }

LimbRig rig_of(const Triangles& surface) { return bones_of(limbs(surface), {.radius = radius}); }

double fraction_inside(const Skeleton& skeleton, const Triangles& surface) {
  std::vector<std::array<Vec3, 3>> faces;
  for (const auto& [a, b, c] : surface.faces)
    faces.push_back({surface.points[a], surface.points[b], surface.points[c]});
  const Winding winding(std::move(faces));
  double inside = 0, all = 0;
  for (const Bone& bone : skeleton.bones)
    for (int i = 0; i < 20; ++i) {
      all += bone.length;
      const Vec3 place = bone.head() + (i + 0.5) / 20 * bone.length * bone.axis();
      if (winding.around(place).value_or(0) > 0) inside += bone.length;
    }
  return inside / all;
}

double nearest_tail(const Skeleton& skeleton, const Vec3& place) {
  double least = 1e9;
  for (const Bone& bone : skeleton.bones) least = std::min(least, (bone.tail() - place).norm());
  return least;
}

std::size_t tips_of(const std::vector<Limb>& all) {
  return static_cast<std::size_t>(std::count_if(
      all.begin(), all.end(), [](const Limb& limb) { return limb.end == Limb::End::tip; }));
}

Triangles triangles_of(const PolygonSoup& soup) { return clean(soup).triangles; }

class Star : public testing::TestWithParam<int> {};

TEST_P(Star, HasAChainToTheEndOfEveryArm) {
  const Triangles surface = star(GetParam());
  EXPECT_EQ(tips_of(limbs(surface)), static_cast<std::size_t>(GetParam()));
  const LimbRig rig = rig_of(surface);
  const Skeleton skeleton = make_skeleton(rig.bones);  // refuses parents that come later
  EXPECT_GE(fraction_inside(skeleton, surface), 0.9);
  int roots = 0;
  for (const Bone& bone : skeleton.bones) roots += bone.parent == no_bone;
  EXPECT_EQ(roots, 1);
  for (int i = 0; i < GetParam(); ++i) {
    const double turn = 2 * pi * i / GetParam();
    EXPECT_LT(nearest_tail(skeleton, arm * Vec3(std::cos(turn), std::sin(turn), 0)), 2 * radius);
  }
}

TEST_P(Star, BendsEveryArmByTheAngle) {
  const LimbRig rig = rig_of(star(GetParam()));
  const Skeleton skeleton = make_skeleton(rig.bones);
  const Pose pose = pose_at(skeleton, make_motion(rig.tracks, skeleton), 0.6);
  std::vector<bool> holds(skeleton.size());
  for (const Bone& bone : skeleton.bones)
    if (bone.parent >= 0) holds[bone.parent] = true;
  for (std::size_t b = 0; b < skeleton.size(); ++b)
    if (!holds[b]) {
      EXPECT_NEAR(degrees(Eigen::AngleAxisd(pose[b].turn).angle()), 30, 0.1);
    }
}

INSTANTIATE_TEST_SUITE_P(Arms, Star, testing::Range(3, 9));

TEST(NewBones, AreTheSameOnAnyThreadsWhateverWasDoneBefore) {
  const Triangles surface = star(5);
  const LimbRig first = rig_of(surface);
  for (const int threads : {1, 3}) {
    LimbRig again;
    with_threads(threads, [&] {
      rig_of(star(4));
      again = rig_of(surface);
    });
    ASSERT_EQ(again.bones.size(), first.bones.size());
    for (std::size_t b = 0; b < first.bones.size(); ++b)
      EXPECT_EQ(*again.bones[b].tail, *first.bones[b].tail);
  }
}

TEST(NewBones, TurnAndMoveWithTheMesh) {
  const Triangles surface = star(5);
  const Mat3 turn = Eigen::AngleAxisd(1.1, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const Vec3 shift(5, -3, 2);
  Triangles moved = surface;
  for (Vec3& point : moved.points) point = turn * point + shift;
  const Skeleton before = make_skeleton(rig_of(surface).bones);
  const Skeleton after = make_skeleton(rig_of(moved).bones);
  for (const Bone& bone : before.bones) {
    double least = 1e9;  // from the tail to any of the moved bones
    for (const Bone& other : after.bones)
      least = std::min(least, distance_to(other, turn * bone.tail() + shift));
    EXPECT_LT(least, 2 * radius);
  }
}

TEST(NewBones, LieAlongTheAxisOfBodiesWithoutLimbs) {
  for (const PolygonSoup& soup :
       {shapes::sphere(0.1, 3), shapes::box(Vec3::Constant(-0.1), Vec3::Constant(0.1))}) {
    const Skeleton skeleton = make_skeleton(rig_of(triangles_of(soup)).bones);
    EXPECT_EQ(skeleton.size(), 3u);
    EXPECT_LT(nearest_tail(skeleton, Vec3(0, 0, 0.1)), 2 * radius);
    EXPECT_LT(nearest_tail(skeleton, Vec3(0, 0, -0.1)), 2 * radius);
  }
}

TEST(NewBones, OfARingAreCutOpenAndMeetAgainWhenItFolds) {
  const LimbRig rig = rig_of(triangles_of(shapes::torus(0.2, 0.05)));
  const Skeleton skeleton = make_skeleton(rig.bones);
  const Pose pose = pose_at(skeleton, make_motion(rig.tracks, skeleton), 0.6);
  std::vector<Vec3> rest, now;
  for (std::size_t b = 0; b < skeleton.size(); ++b) {
    bool holds = false;
    for (const Bone& bone : skeleton.bones) holds = holds || bone.parent == static_cast<int>(b);
    if (holds) continue;
    rest.push_back(skeleton.bones[b].tail());
    now.push_back(pose[b].carried(skeleton.bones[b].tail(), skeleton.bones[b]));
  }
  ASSERT_EQ(rest.size(), 2u);
  EXPECT_LT((rest[0] - rest[1]).norm(), 4 * radius);
  EXPECT_LT((now[0] - now[1]).norm(), 5 * radius);
  EXPECT_GT((now[0] - rest[0]).norm(), 2 * radius);
}

TEST(NewBones, TakePartsThatOverlapAsOneBody) {
  const auto column = shapes::box(Vec3(-0.05, -0.05, 0), Vec3(0.05, 0.05, 0.6));
  const auto bar = shapes::box(Vec3(-0.4, -0.04, 0.25), Vec3(0.4, 0.04, 0.35));
  const auto cross = limbs(triangles_of(shapes::together(column, bar)));
  EXPECT_EQ(tips_of(cross), 4u);
  EXPECT_EQ(cross.back().body, 0);
  const auto apart =
      limbs(triangles_of(shapes::together(column, shapes::moved(column, Vec3(0.5, 0, 0)))));
  EXPECT_EQ(apart.back().body, 1);
}

TEST(NewBones, OfAnOpenMeshAreThoseOfTheClosedOne) {
  Triangles open = star(4);
  open.faces.erase(open.faces.begin() + 3);
  EXPECT_EQ(tips_of(limbs(open)), 4u);
}

TEST(Refined, KeepsPlacesVolumeAndClosure) {
  const Triangles box = triangles_of(shapes::box(Vec3::Zero(), Vec3(1, 2, 3)));
  const Triangles fine = refined(box, 0.3);
  EXPECT_LE(longest_side(fine), 0.3);
  EXPECT_NEAR(volume(fine), 6, 1e-12);
  EXPECT_NEAR(area(fine), area(box), 1e-12);
  EXPECT_EQ(border_of(fine, edge_uses(fine), border_loops(edge_uses(fine))).edges, 0u);
}

/// A rod a thousand times as long as wide: faces go with its length, not with a power of it.
TEST(Refined, CutsNeedlesAcross) {
  const double width = 1e-3, longest = 2e-3;
  const Triangles rod = triangles_of(shapes::box(Vec3::Zero(), Vec3(width, width, 1)));
  const Triangles fine = refined(rod, longest);
  EXPECT_LE(longest_side(fine), longest);
  EXPECT_NEAR(volume(fine), width * width, 1e-12);
  EXPECT_NEAR(area(fine), area(rod), 1e-12);
  EXPECT_EQ(border_of(fine, edge_uses(fine), border_loops(edge_uses(fine))).edges, 0u);
  const double pieces_per_side = 512;
  EXPECT_LT(static_cast<double>(fine.faces.size()), 8 * 2 * 3 * pieces_per_side);
}

TEST(Solids, AreClosedAndHaveTheirVolume) {
  const Vec3 size(0.1, 0.2, 0.5);
  const double pillar = pi / 4 * 0.1 * 0.2;
  const std::array<double, 4> volumes = {0.01, pillar * 0.5 * 2 / 3, pillar * 0.5,
                                         pillar * (0.4 + 0.1 * 2 / 3)};
  for (int i = 0; i < 4; ++i) {
    const Triangles body = solid(static_cast<SolidShape>(i), size);
    EXPECT_EQ(border_of(body, edge_uses(body), border_loops(edge_uses(body))).edges, 0u);
    EXPECT_NEAR(volume(body), volumes[i], 0.01 * volumes[i]);
    EXPECT_TRUE(bounds(body.points).sizes().isApprox(size, 0.01));
    EXPECT_EQ(bounds(body.points).min().z(), 0);
  }
  const Vec3 from(1, 2, 3), to(1.2, 1.9, 3.3);
  const Triangles capsule = capsule_between(from, to, 0.05);
  for (const Vec3& point : capsule.points) {
    const double fraction =
        std::clamp((point - from).dot(to - from) / (to - from).squaredNorm(), 0., 1.);
    EXPECT_NEAR((point - from - fraction * (to - from)).norm(), 0.05, 1e-9);
  }
}

TEST(Thickened, IsAClosedLayer) {
  const Triangles sheet{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  const Triangles layer = thickened(sheet, 0.1);
  EXPECT_NEAR(volume(layer), 0.1, 1e-12);
  EXPECT_EQ(border_of(layer, edge_uses(layer), border_loops(edge_uses(layer))).edges, 0u);
}

}  // namespace sinew::new_bones_test

// SPDX-License-Identifier: GPL-3.0-or-later
// A body for a rig alone: what is a figure, which pose it is made in, and that its limbs are apart.
#include <sinew/rig/figure/figure.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include <sinew/rig/rest_at.h>

namespace sinew::figure_test {

struct Given {
  const char* name;
  int parent;
  Vec3 offset;
};

/// A figure in T pose, m, z up, which looks along x; its names say nothing.
std::vector<Joint> human() {
  const std::vector<Given> given = {
      {"a", no_bone, {0, 0, 0.95}}, {"b", 0, {0, 0, 0.12}},   {"c", 1, {0, 0, 0.18}},
      {"d", 2, {0, 0, 0.24}},       {"e", 3, {0, 0, 0.1}},    {"f", 2, {0, 0.18, 0.2}},
      {"g", 5, {0, 0.28, 0}},       {"h", 6, {0, 0.25, 0}},   {"i", 2, {0, -0.18, 0.2}},
      {"j", 8, {0, -0.28, 0}},      {"k", 9, {0, -0.25, 0}},  {"l", 0, {0, 0.1, -0.04}},
      {"m", 11, {0, 0, -0.42}},     {"n", 12, {0, 0, -0.4}},  {"o", 13, {0.14, 0, -0.08}},
      {"p", 0, {0, -0.1, -0.04}},   {"q", 15, {0, 0, -0.42}}, {"r", 16, {0, 0, -0.4}},
      {"s", 17, {0.14, 0, -0.08}}};
  std::vector<Joint> joints;
  for (const Given& one : given) {
    const Vec3 from = one.parent == no_bone ? Vec3::Zero() : joints[one.parent].place;
    joints.push_back({one.name, one.parent, from + one.offset, {}});
  }
  const auto end = [&](std::size_t joint, const Vec3& to) {
    joints[joint].end = joints[joint].place + to;
  };
  end(4, {0, 0, 0.18}), end(7, {0, 0.17, 0}), end(10, {0, -0.17, 0});
  end(14, {0.08, 0, 0}), end(18, {0.08, 0, 0});
  return joints;
}

/// The same with all bones along x, as some suits write it.
std::vector<Joint> in_one_line() {
  const std::vector<Joint> upright = human();
  std::vector<Joint> joints = upright;
  for (std::size_t j = 1; j < joints.size(); ++j) {
    const auto parent = static_cast<std::size_t>(joints[j].parent);
    const double link = (upright[j].place - upright[parent].place).norm();
    joints[j].place = joints[parent].place + link * Vec3::UnitX();
    if (upright[j].end)
      joints[j].end = joints[j].place + (*upright[j].end - upright[j].place).norm() * Vec3::UnitX();
  }
  return joints;
}

Track constant(int bone, const Quat& rotation) {
  Track track;
  track.bone = bone;
  track.rotation.interpolation = Interpolation::linear;
  track.rotation.times = {0, 1};
  track.rotation.values = {Quat::Identity(), rotation};
  return track;
}

/// A clip that begins in one line and is upright, with limbs apart, from 1 s on.
Rig suit() {
  const std::vector<Joint> upright = human();
  Rig rig;
  rig.skeleton = skeleton_of(in_one_line());
  Clip clip;
  std::vector<Quat> turned(upright.size());
  std::vector<bool> has_child(upright.size());
  for (std::size_t j = upright.size(); j-- > 0;) {
    Vec3 to = upright[j].end.value_or(upright[j].place);
    for (std::size_t k = upright.size(); k-- > j + 1;)
      if (upright[k].parent == static_cast<int>(j)) to = upright[k].place;
    turned[j] = Quat::FromTwoVectors(Vec3::UnitX(), to - upright[j].place);
  }
  // The hips and the chest lead to several joints, all on one line: these spread as far as they do.
  for (std::size_t j = 0; j < upright.size(); ++j) {
    const int parent = upright[j].parent;
    const Quat up = parent == no_bone ? Quat::Identity() : turned[static_cast<std::size_t>(parent)];
    clip.motion.tracks.push_back(constant(static_cast<int>(j), up.conjugate() * turned[j]));
  }
  rig.clips.push_back(clip);
  return rig;
}

Skeleton turned(const Skeleton& skeleton, const Mat3& turn) {
  return placed(skeleton, {1, turn, Vec3::Zero()});
}

TEST(Anatomy, FindsLimbsTrunkAndHeadByLengthsAlone) {
  const Anatomy anatomy = anatomy_of(skeleton_of(human()));
  ASSERT_TRUE(anatomy.is_figure());
  EXPECT_EQ(anatomy.legs().joint, (std::array<int, 2>{11, 15}));
  EXPECT_EQ(anatomy.arms().joint, (std::array<int, 2>{5, 8}));
  EXPECT_EQ(anatomy.trunk, (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(anatomy.head, (std::vector<int>{3, 4}));
  EXPECT_NEAR(anatomy.height, 1.72, 0.1);
}

TEST(Anatomy, IsTheSameInAnyPose) {
  const Anatomy upright = anatomy_of(skeleton_of(human()));
  const Anatomy line = anatomy_of(skeleton_of(in_one_line()));
  ASSERT_TRUE(line.is_figure());
  EXPECT_EQ(line.legs().joint, upright.legs().joint);
  EXPECT_EQ(line.arms().tip, upright.arms().tip);
  EXPECT_NEAR(line.height, upright.height, 0.05 * upright.height);
}

/// A figure whose collar bones, so long each, leave the chest at one place.
std::vector<Joint> with_collars(const std::array<double, 2>& lengths) {
  const std::vector<Joint> old = human();
  std::vector<Joint> joints(old.begin(), old.begin() + 5);
  for (const int side : {0, 1}) {
    const double sign = side == 0 ? 1 : -1;
    Vec3 place = old[2].place + Vec3(0, 0, 0.2);
    joints.push_back({"collar", 2, place, {}});
    for (const auto& [name, link] :
         {std::pair{"arm", lengths[side]}, {"forearm", 0.28}, {"hand", 0.25}}) {
      place += sign * link * Vec3::UnitY();
      joints.push_back({name, static_cast<int>(joints.size()) - 1, place, {}});
    }
    joints.back().end = place + sign * 0.17 * Vec3::UnitY();
  }
  for (std::size_t j = 11; j < old.size(); ++j) {
    joints.push_back(old[j]);
    if (joints.back().parent >= 11) joints.back().parent += 2;
  }
  return joints;
}

TEST(Anatomy, CutsBothArmsAtTheSameJoint) {
  for (const double collar : {0.12, 0.14, 0.155}) {  // about half as long as an upper arm
    const Skeleton skeleton = skeleton_of(with_collars({0.97 * collar, 1.03 * collar}));
    const Anatomy anatomy = anatomy_of(skeleton);
    ASSERT_TRUE(anatomy.is_figure());
    for (const int joint : anatomy.arms().joint)
      EXPECT_EQ(skeleton.bones[joint].name.substr(0, 3), "arm");
  }
}

TEST(Anatomy, OfAChainIsNoFigure) {
  std::vector<Joint> rope;
  for (int j = 0; j < 12; ++j) rope.push_back({std::to_string(j), j - 1, Vec3(0.1 * j, 0, 0), {}});
  EXPECT_FALSE(anatomy_of(skeleton_of(rope)).is_figure());
}

TEST(Anatomy, FindsUpHoweverTheFileIsTurned) {
  const Skeleton skeleton = skeleton_of(human());
  for (const Mat3& turn : {rotation_of({0, 0, 0}), rotation_of({90, 0, 0}), rotation_of({0, 90, 0}),
                           rotation_of({180, 0, 0})}) {
    const Skeleton other = turned(skeleton, turn);
    const Vec3 up = up_in(anatomy_of(other), other, {rest_pose(other)});
    EXPECT_GT(up.normalized().dot(turn.col(2)), 0.95);
  }
}

/// Checks every two parts that are no neighbors.
void expect_apart(const Skeleton& skeleton) {
  const Anatomy anatomy = anatomy_of(skeleton);
  const std::vector<FigurePart> parts = figure_of(skeleton, anatomy);
  const Neighborhood near(skeleton, anatomy);
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (std::size_t k = i + 1; k < parts.size(); ++k)
      EXPECT_LE(parts[i].radius + parts[k].radius, near.distance(parts[i], parts[k]))
          << skeleton.bones[parts[i].bone].name << ' ' << skeleton.bones[parts[k].bone].name;
}

TEST(Figure, HasLimbsThatReachNoOthers) {
  expect_apart(skeleton_of(human()));
  std::vector<Joint> narrow = human();  // legs 4 cm apart
  for (const std::size_t leg : {11, 15})
    for (std::size_t j = leg; j < leg + 4; ++j) {
      const double nearer = leg == 11 ? -0.08 : 0.08;
      narrow[j].place.y() += nearer;
      if (narrow[j].end) narrow[j].end->y() += nearer;
    }
  const Skeleton skeleton = skeleton_of(narrow);
  expect_apart(skeleton);
  double thickest = 0;
  for (const FigurePart& part : figure_of(skeleton, anatomy_of(skeleton)))
    if (part.bone == 12) thickest = std::max(thickest, part.radius);
  EXPECT_GT(thickest, 0);
  EXPECT_LT(2 * thickest, 0.04);
}

TEST(Figure, HasArmsThatHangBesideTheTrunk) {
  std::vector<Joint> hanging = human();
  for (const std::size_t arm : {5, 8}) {
    const Vec3 shoulder = hanging[arm].place;
    hanging[arm + 1].place = shoulder - Vec3(0, 0, 0.28);
    hanging[arm + 2].place = shoulder - Vec3(0, 0, 0.53);
    hanging[arm + 2].end = shoulder - Vec3(0, 0, 0.7);
  }
  const Skeleton skeleton = skeleton_of(hanging);
  expect_apart(skeleton);
  double widest = 0;
  const std::vector<FigurePart> parts = figure_of(skeleton, anatomy_of(skeleton));
  for (const FigurePart& arm : parts) {
    if (arm.bone != 5 && arm.bone != 8) continue;
    if (arm.kind != FigurePart::Kind::limb) continue;
    const Vec3 middle = (arm.from + arm.to) / 2;
    const FigurePart lower{arm.bone, no_bone, arm.kind, middle, arm.to, arm.radius};
    for (const FigurePart& trunk : parts) {
      if (trunk.kind != FigurePart::Kind::trunk) continue;
      widest = std::max(widest, trunk.to.y() + trunk.radius);
      EXPECT_GT(distance_between(lower, trunk) - arm.radius - trunk.radius, 0.01);
    }
  }
  EXPECT_GT(widest, 0.1);  // the hips
}

TEST(Figure, IsAsWideAsHipsAndShouldersAndAsHighAsItsHead) {
  const Skeleton skeleton = skeleton_of(human());
  Box trunk, all;
  for (const FigurePart& part : figure_of(skeleton, anatomy_of(skeleton)))
    for (const Vec3& end : {part.from, part.to}) {
      const Vec3 thick = Vec3::Constant(part.radius);
      all.extend(Box(end - thick, end + thick));
      if (part.kind == FigurePart::Kind::trunk) trunk.extend(Box(end - thick, end + thick));
    }
  EXPECT_GE(trunk.sizes().y(), 0.36);
  EXPECT_LE(trunk.sizes().y(), 0.36 + 0.15);
  EXPECT_NEAR(all.max().z(), 0.95 + 0.12 + 0.18 + 0.24 + 0.1 + 0.18, 0.02);
}

TEST(RestAt, MovesJointsAndEndsAsBefore) {
  Rig rig = suit();
  rig.clips[0].motion.tracks[0].translation.times = {0, 1};
  rig.clips[0].motion.tracks[0].translation.values = {Vec3(0, 0, 0), Vec3(1, 2, 3)};
  const Motion& before = rig.clips[0].motion;
  const Rig other = with_rest_at(rig, before, 0.6);
  const Motion& after = other.clips[0].motion;
  for (const double time : {0.0, 0.3, 0.6, 1.0, 2.0}) {
    const Pose a = pose_at(rig.skeleton, before, time), b = pose_at(other.skeleton, after, time);
    for (std::size_t j = 0; j < a.size(); ++j)
      EXPECT_LT((a[j].frame.origin - b[j].frame.origin).norm(), 1e-12);
    for (const std::size_t tip : {4, 7, 14})
      EXPECT_LT((a[tip].carried(rig.skeleton.bones[tip].tail(), rig.skeleton.bones[tip]) -
                 b[tip].carried(other.skeleton.bones[tip].tail(), other.skeleton.bones[tip]))
                    .norm(),
                1e-12);
  }
  const Pose at_rest = pose_at(other.skeleton, after, 0.6);
  for (std::size_t j = 0; j < at_rest.size(); ++j)
    EXPECT_TRUE(at_rest[j].turn.isApprox(Mat3::Identity(), 1e-9));
}

TEST(RestAt, MakesAFigureOfARigThatRestsInOneLine) {
  const Rig rig = suit();
  const Anatomy anatomy = anatomy_of(rig.skeleton);
  const auto time = best_pose(rig, anatomy, Vec3::UnitZ());
  ASSERT_TRUE(time);
  EXPECT_GT(*time, 0.7);
  const Skeleton posed = with_rest_at(rig, rig.clips[0].motion, *time).skeleton;
  const std::vector<double> before = links_of(rig.skeleton), after = links_of(posed);
  for (std::size_t j = 0; j < before.size(); ++j) EXPECT_NEAR(after[j], before[j], 1e-12);
  for (const int tip : {4, 7, 14})
    EXPECT_NEAR(posed.bones[tip].length, rig.skeleton.bones[tip].length, 1e-12);
  expect_apart(posed);
}

/// A hand of three fingers, whose middle joints the clip holds at an angle to their rest.
Rig hand(double angle) {
  std::vector<Joint> joints = {{"wrist", no_bone, Vec3::Zero(), {}}};
  Rig rig;
  rig.clips.emplace_back();
  for (const double side : {-1.0, 0.0, 1.0}) {
    const int knuckle = static_cast<int>(joints.size());
    const Vec3 first(1, 0.3 * side, 0);
    joints.push_back({"knuckle" + std::to_string(knuckle), 0, first, {}});
    joints.push_back({"middle" + std::to_string(knuckle), knuckle, first + Vec3(0.4, 0, 0), {}});
    const double back = 0.4 - 0.3;  // folded back along the finger
    joints.push_back({"end" + std::to_string(knuckle), knuckle + 1, first + Vec3(back, 0, 0), {}});
    joints.back().end = first + Vec3(back - 0.2, 0, 0);
    const Quat turn(Eigen::AngleAxisd(angle, Vec3::UnitZ()));
    rig.clips[0].motion.tracks.push_back(constant(knuckle + 1, turn));
    rig.clips[0].motion.tracks.back().rotation.values.front() = turn;
  }
  rig.skeleton = skeleton_of(joints);
  return rig;
}

TEST(RestAt, UnfoldsWhatIsNoFigureOnlyWhereItsRestIsNeverNear) {
  const Rig folded = hand(pi), bent = hand(pi / 2);
  ASSERT_FALSE(anatomy_of(folded.skeleton).is_figure());
  EXPECT_TRUE(best_pose(folded, anatomy_of(folded.skeleton), Vec3::UnitZ()));
  EXPECT_FALSE(best_pose(bent, anatomy_of(bent.skeleton), Vec3::UnitZ()));
}

TEST(RestAt, LeavesARestPoseThatServes) {
  Rig rig;
  rig.skeleton = skeleton_of(human());
  rig.clips.emplace_back();
  rig.clips[0].motion.tracks = {constant(0, Quat(Eigen::AngleAxisd(1, Vec3::UnitZ())))};
  EXPECT_FALSE(best_pose(rig, anatomy_of(rig.skeleton), Vec3::UnitZ()));
}

}  // namespace sinew::figure_test

// SPDX-License-Identifier: GPL-3.0-or-later
// The bounds on approach by the bones' motions hold, and are not far too large.
#include <sinew/physics/lists/approach_bounds.h>

#include <numeric>

#include <sinew/scene/rig.h>

#include "all_steppers.h"

namespace sinew {
namespace {

constexpr double r = 0.01, range = 3.6 * r, b = 2.6 * r;

RigidMotion random_motion(std::mt19937& random, double angle, double shift) {
  return {test::turned(test::random_vector(random), angle), shift * test::random_vector(random)};
}

/// A motion a little after `first`.
RigidMotion after(const RigidMotion& first, std::mt19937& random, double angle, double shift) {
  const RigidMotion more = random_motion(random, angle, shift);
  return {more.turn * first.turn, more.turn * first.shift + more.shift};
}

Vec3 moved(const RigidMotion& motion, const Vec3& x) { return motion.turn * x + motion.shift; }

/// A body whose particles follow groups, and their contacts.
struct Scene {
  Points points;
  std::vector<std::uint32_t> lead;
  std::size_t groups;
  Contacts contacts;

  Scene(Points at, std::vector<std::uint32_t> leads)
      : points(std::move(at)),
        lead(std::move(leads)),
        groups(*std::max_element(lead.begin(), lead.end()) + std::size_t{1}) {
    BlockState<double> state(points.size());
    const Units meters;
    for (std::size_t k = 0; k < points.size(); ++k) state.set_position(k, points[k], meters);
    contacts = Contacts(state, meters, lead, groups, range);
  }
};

/// A bar cut across into `groups` parts.
Scene bar(std::size_t groups) {
  const Points points = test::fcc_box(5, 5, 41, r);
  std::vector<std::uint32_t> lead;
  for (std::size_t k = 0; k < points.size(); ++k)
    lead.push_back(static_cast<std::uint32_t>(k * groups / points.size()));
  return {points, lead};
}

/// Two bars side by side, 12 r apart.
Scene two_bars() {
  Points points = test::fcc_box(5, 5, 25, r);
  const std::size_t half = points.size();
  for (std::size_t k = 0; k < half; ++k) points.push_back(points[k] + Vec3(16 * r, 0, 0));
  std::vector<std::uint32_t> lead(2 * half, 0);
  std::fill(lead.begin() + static_cast<std::ptrdiff_t>(half), lead.end(), std::uint32_t{1});
  return {points, lead};
}

/// Groups in no order.
Scene mixed() {
  const Points points = test::fcc_box(7, 7, 25, r);
  std::vector<std::uint32_t> lead;
  std::mt19937 random(2);
  for (std::size_t k = 0; k < points.size(); ++k) lead.push_back(random() % 3);
  return {points, lead};
}

/// All of the body in one cell, two groups in it.
Scene handful() { return {test::fcc_box(2, 2, 4, r), {0, 0, 1, 1, 0, 0, 1, 1}}; }

std::vector<Scene> scenes() { return {bar(2), bar(4), two_bars(), mixed(), handful()}; }

std::vector<RigidMotion> random_motions(std::size_t count, std::mt19937& random, double angle,
                                        double shift) {
  std::vector<RigidMotion> motions;
  for (std::size_t group = 0; group < count; ++group)
    motions.push_back(random_motion(random, angle, shift));
  return motions;
}

constexpr std::pair<double, double> sizes[] = {{0.5, 0.1 * r}, {3, r}, {20, 5 * r}, {180, 40 * r}};

TEST(Contacts, NoPairOutsideTheListsComesNearerThanApproachAllows) {
  std::mt19937 random(1);
  for (const Scene& scene : scenes())
    for (const auto& [angle, shift] : sizes)
      for (int trial = 0; trial < 6; ++trial) {
        const auto motions = random_motions(scene.groups, random, angle, shift);
        const double least = range - scene.contacts.approach(motions);
        Points now;
        for (std::size_t k = 0; k < scene.points.size(); ++k)
          now.push_back(moved(motions[scene.lead[k]], scene.points[k]));
        for (std::size_t i = 0; i < now.size(); i += 3)
          for (std::size_t j = 0; j < i; ++j) {
            if ((scene.points[i] - scene.points[j]).norm() < range) continue;
            ASSERT_GE((now[i] - now[j]).norm(), least - 1e-12);
          }
      }
}

TEST(Contacts, NoListedPairComesNearerThanApproachSinceAllows) {
  std::mt19937 random(2);
  for (const Scene& scene : scenes())
    for (const auto& [angle, shift] : sizes)
      for (int trial = 0; trial < 6; ++trial) {
        const auto earlier = random_motions(scene.groups, random, angle, shift);
        std::vector<RigidMotion> later;
        for (const RigidMotion& motion : earlier)
          later.push_back(after(motion, random, 0.2 * angle, 0.2 * shift));
        const double escaped = r / 2;  // distance of particles from where their bones moved them
        const double most = scene.contacts.approach_since(earlier, later, escaped);
        Points then, now;
        for (std::size_t k = 0; k < scene.points.size(); ++k) {
          const Vec3 at = scene.points[k] + escaped * test::random_vector(random).normalized();
          then.push_back(moved(earlier[scene.lead[k]], at));
          now.push_back(moved(later[scene.lead[k]], at));
        }
        for (std::size_t i = 0; i < now.size(); i += 3)
          for (std::size_t j = 0; j < i; ++j) {
            if ((scene.points[i] - scene.points[j]).norm() >= range) continue;
            ASSERT_GE((now[i] - now[j]).norm(), (then[i] - then[j]).norm() - most - 1e-12);
          }
      }
}

TEST(Contacts, BoundReach) {
  std::mt19937 random(3);
  for (const Scene& scene : scenes())
    for (int sample = 0; sample < 3; ++sample) {
      const Vec3 place = test::random_vector(random);
      for (std::size_t k = 0; k < scene.points.size(); ++k)
        ASSERT_LE((scene.points[k] - place).norm(),
                  scene.contacts.reach_from(place, scene.lead[k]) + 1e-12);
    }
}

TEST(Contacts, BonesThatMoveAsOneBringNothingNearer) {
  std::mt19937 random(4);
  for (const Scene& scene : scenes())
    for (const auto& [angle, shift] : sizes) {
      const RigidMotion motion = random_motion(random, angle, shift);
      const std::vector<RigidMotion> motions(scene.groups, motion);
      EXPECT_LT(scene.contacts.approach(motions), 1e-12);
      const std::vector<RigidMotion> later(scene.groups, after(motion, random, angle, shift));
      EXPECT_LT(scene.contacts.approach_since(motions, later, r), 1e-12);
    }
}

TEST(Contacts, OnlyTheSurroundingsOfAJointCountInABend) {
  const Scene scene = bar(2);
  const Vec3 joint(0, 0, 41 * half_plane_spacing(r) / 2);
  const Mat3 turn = test::turned(Vec3::UnitY(), 1);
  const std::vector<RigidMotion> bend{{}, {turn, joint - turn * joint}};
  // Two rings of cells around the joint, and half a diagonal across: not the bar's 29 r.
  EXPECT_LT(scene.contacts.approach(bend), 12 * r * radians(1));
  EXPECT_GT(scene.contacts.approach(bend), 2 * r * radians(1));
}

TEST(Contacts, ATurnBringsParticlesNearerTheFurtherTheyHaveEscaped) {
  const Scene scene = bar(2);
  const Vec3 joint(0, 0, 41 * half_plane_spacing(r) / 2);
  const Mat3 turn = test::turned(Vec3::UnitY(), 1);
  const std::vector<RigidMotion> rest(2), bend{{}, {turn, joint - turn * joint}};
  const double near = scene.contacts.approach_since(rest, bend, 0);
  for (const double escaped : {r, 10 * r, 1000 * r}) {
    const double most = scene.contacts.approach_since(rest, bend, escaped);
    EXPECT_GE(most, 2 * std::sin(radians(0.5)) * escaped);
    EXPECT_LE(most, near + 1.5 * radians(1) * escaped);
  }
}

TEST(Contacts, GroupsFarApartMayMoveFreelyAtFirst) {
  const Scene scene = two_bars();  // 10 r between their surfaces
  const auto pushed = [](double shift) {
    return std::vector<RigidMotion>{{}, {Mat3::Identity(), Vec3(-shift, 0, 0)}};
  };
  EXPECT_EQ(scene.contacts.approach(pushed(2 * r)), 0);
  EXPECT_GT(scene.contacts.approach(pushed(10 * r)), range - b);
}

TEST(MotionsBetween, MapPointsFixedToTheBones) {
  Settings settings = test::box_scene(25);
  KeyDefinition end = test::bend_key(1, 70);
  end.twist = 30;
  end.translation = {0.1, 0.2, -0.1};
  settings.tracks = {test::track("lower", {test::bend_key(0, 0), end}),
                     test::track("upper", {test::bend_key(0, 0), end})};
  const Skeleton skeleton = skeleton_of(settings);
  const Motion motion = motion_of(settings, skeleton);
  const Pose before = pose_at(skeleton, motion, 0.3), now = pose_at(skeleton, motion, 0.8);
  const auto motions = motions_between(before, now);
  ASSERT_EQ(motions.size(), 3u);
  std::mt19937 random(5);
  for (std::size_t bone = 0; bone < 2; ++bone) {
    const Vec3 x = test::random_vector(random);
    EXPECT_LT((moved(motions[bone], carried(x, skeleton.bones[bone].rest, before[bone].frame)) -
               carried(x, skeleton.bones[bone].rest, now[bone].frame))
                  .norm(),
              1e-14);
  }
  EXPECT_EQ(motions[2].turn, Mat3(Mat3::Identity()));
  EXPECT_EQ(motions[2].shift, Vec3(Vec3::Zero()));
}

TEST(Drift, HoldsWhileTwiceTheDisplacementAndTheApproachAreLessThanTheSkin) {
  Drift drift(10);
  EXPECT_TRUE(drift.holds(0));
  EXPECT_FALSE(drift.holds(10));
  drift.add(2), drift.add(2);
  EXPECT_DOUBLE_EQ(drift.moved(), 4);
  EXPECT_TRUE(drift.holds(1.9));
  EXPECT_FALSE(drift.holds(2));
  drift.reset(1);
  EXPECT_TRUE(drift.holds(7.9));
  EXPECT_FALSE(drift.holds(8));
  EXPECT_FALSE(Drift().holds(0));
}

TEST(ExcessOfStep, BoundsTheMotionBeyondABonesVelocity) {
  std::mt19937 random(6);
  for (const Interpolation interpolation :
       {Interpolation::smooth, Interpolation::linear, Interpolation::step}) {
    Settings settings = test::box_scene(25);
    KeyDefinition end = test::bend_key(1, 170);
    end.twist = 400;
    end.translation = {3, -2, 1};
    settings.tracks = {test::track("lower", {test::bend_key(0, 0), end})};
    settings.tracks[0].interpolation = interpolation;
    const Skeleton skeleton = skeleton_of(settings);
    const Motion motion = motion_of(settings, skeleton);
    for (const double from : {-0.005, 0.0, 0.3, 0.995})
      for (const double step : {1e-4, 1e-2}) {
        const BonePose before = pose_at(skeleton, motion, from)[0];
        const BonePose now = pose_at(skeleton, motion, from + step)[0];
        const double reach = 0.4, most = excess_of_step(before, now, step, reach);
        for (int trial = 0; trial < 50; ++trial) {
          const Vec3 local = reach * test::random_vector(random).normalized();
          const Vec3 x = before.frame.origin + before.frame.rotation * local;
          const Vec3 y = now.frame.origin + now.frame.rotation * local;
          ASSERT_LE((y - x - step * before.velocity_at(x)).norm(), most + 1e-14);
        }
      }
  }
}

TEST(ExcessOfStep, FallsWithTheSquareOfTheStepAndVanishesForSteadyTravel) {
  Settings settings = test::box_scene(25);
  settings.tracks = {test::track("lower", {test::bend_key(0, 0), test::bend_key(1, 100)})};
  const Skeleton skeleton = skeleton_of(settings);
  const auto excess = [&](double step) {
    const Motion motion = motion_of(settings, skeleton);
    return excess_of_step(pose_at(skeleton, motion, 0.4)[0],
                          pose_at(skeleton, motion, 0.4 + step)[0], step, 1);
  };
  EXPECT_NEAR(excess(1e-3) / excess(5e-4), 4, 0.02);
  KeyDefinition end = test::bend_key(1, 0);
  end.translation = {30, 0, 0};
  settings.tracks = {test::track("lower", {test::bend_key(0, 0), end})};
  settings.tracks[0].interpolation = Interpolation::linear;
  EXPECT_LT(excess(1e-3), 1e-14);
}

TEST(GroupCells, MeetWhereverAPairOfTwoGroupsIsWithinReach) {
  std::mt19937 random(5);
  const Units meters;
  constexpr std::size_t count = 1500, groups = 300;
  BlockState<double> state(count);
  Points points;
  std::vector<std::uint32_t> group;
  for (std::size_t k = 0; k < count; ++k) {
    points.push_back(40 * r * test::random_vector(random));
    group.push_back(static_cast<std::uint32_t>(random() % groups));
    state.set_position(k, points[k], meters);
  }
  const auto met = GroupCells(state, meters, group, range).meetings();
  std::size_t pairs = 0;
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = 0; j < count; ++j) {
      const double apart = (points[i] - points[j]).norm();
      if (group[i] >= group[j] || apart >= range) continue;
      const auto found = met.find({group[i], group[j]});
      ASSERT_NE(found, met.end()) << (points[i] - points[j]).transpose() / range;
      EXPECT_LE(found->second.gap, apart);
      EXPECT_TRUE(found->second.near_a.contains(points[i]));
      EXPECT_TRUE(found->second.near_b.contains(points[j]));
      ++pairs;
    }
  EXPECT_GT(pairs, 1000u);
  EXPECT_LT(met.size(), 2 * pairs);  // not all groups with all
}

}  // namespace
}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// Groups beside obstacles, and beside other bodies: what presses on each other is free and yields,
// as it would without groups.
#include <gtest/gtest.h>

#include <sinew/groups/kept_free.h>
#include <sinew/groups/static_groups.h>

#include "support/expect_error.h"
#include "support/grouped_bar.h"

namespace sinew::near_obstacles_test {

using namespace groups_test;
namespace {

constexpr int width = 17, height = 81;
const double s = half_plane_spacing(r), side = width / 2 * s, top = height * s;

PlaceKeySettings moved_to(double time, const Vec3& translation) {
  PlaceKeySettings key;
  key.time = time, key.translation = translation;
  return key;
}

ObstacleSettings ball(const Vec3& center, double radius) {
  ObstacleSettings made;
  made.name = "ball", made.shape = ObstacleShape::sphere;
  made.center = center, made.radius = radius;
  return made;
}

Settings bar_with(const ObstacleSettings& obstacle) {
  Settings settings = test::box_scene(height);
  settings.material.model = MaterialModel::bonded;
  settings.material.young_modulus = 1e5;
  settings.hierarchy.min_particles = 64;
  settings.solver.duration = 0.3;
  settings.world.obstacles = {obstacle};
  return settings;
}

/// A ball that is pressed into the side.
Settings pressed_by_a_ball() {
  ObstacleSettings obstacle = ball({side + 5 * r, 0, 0.6 * top}, 4 * r);
  obstacle.keys = {moved_to(0, Vec3::Zero()), moved_to(0.15, {-3.5 * r, 0, 0})};
  return bar_with(obstacle);
}

/// A rod across the whole side.
Settings pressed_by_a_rod() {
  ObstacleSettings obstacle;
  obstacle.name = "rod", obstacle.shape = ObstacleShape::capsule, obstacle.radius = 3 * r;
  obstacle.from = Vec3(side + 4 * r, -1, 0.6 * top), obstacle.to = Vec3(side + 4 * r, 1, 0.6 * top);
  obstacle.keys = {moved_to(0, Vec3::Zero()), moved_to(0.15, {-3 * r, 0, 0})};
  return bar_with(obstacle);
}

/// The upper half leans on a post that stands still.
Settings leaning_on_a_post() {
  Settings settings = bar_with(ball({side + 14.5 * r, 0, 0.85 * top}, 5 * r));
  settings.tracks = {test::track("upper", {test::bend_key(0, 0), test::bend_key(0.15, 16)})};
  return settings;
}

/// A ball on flesh that no bone holds.
Settings held_in_its_core() {
  Settings settings = pressed_by_a_ball();
  settings.binding.core_radius = 4 * r;
  return settings;
}

Points rest() { return test::fcc_box(width, width, height, r); }

Prepared prepared(Settings settings, bool enabled, bool dynamic = false) {
  settings.hierarchy.enabled = enabled, settings.hierarchy.dynamic = dynamic;
  settings.material.damping_form = DampingForm::paper;
  return test::prepared(settings, rest());
}

struct Pressed {
  double force = 0, grouped = 0;
};

/// At the end, N, and the fraction of the body that is grouped then.
Pressed pressed(const Settings& settings, bool enabled, bool dynamic = false) {
  Simulation simulation = start(prepared(settings, enabled, dynamic));
  while (simulation.time() < settings.solver.duration) simulation.step();
  const auto& grouping = simulation.body().grouping;
  const double all = static_cast<double>(simulation.particles().size());
  return {simulation.reactions_of_obstacles()[0].force.norm(),
          grouping ? static_cast<double>(grouping->grouped()) / all : 0};
}

TEST(NearObstacles, ForcesAreThoseWithoutGroups) {
  for (const Settings& settings :
       {pressed_by_a_ball(), pressed_by_a_rod(), leaning_on_a_post(), held_in_its_core()}) {
    SCOPED_TRACE(settings.world.obstacles[0].name);
    const double alone = pressed(settings, false).force;
    ASSERT_GT(alone, 1);
    for (const bool dynamic : {false, true}) {
      if (dynamic && settings.binding.core_radius) continue;  // refused
      const Pressed grouped = pressed(settings, true, dynamic);
      EXPECT_NEAR(grouped.force, alone, 0.05 * alone);
      EXPECT_GT(grouped.grouped, 0.02);
    }
  }
}

/// Two bars, one across the other, of which one is moved by 3 radii into the other, or away from
/// it.
struct Crossed {
  Points rest;
  Settings settings;

  explicit Crossed(double radii) {
    rest = test::fcc_box(13, 13, 49, r);
    const double middle = 25 * s, shift = 13 * s + r;
    for (const Vec3& X : test::fcc_box(13, 13, 49, r))
      rest.emplace_back(X.x() + shift, X.z() - middle, X.y() + middle);
    settings = bar_with({});
    settings.world = {};
    const Vec3 low(shift, -middle, middle), high(shift, middle, middle);
    settings.bones = {{"lower", "", Vec3(0, 0, 0), Vec3(0, 0, 2 * middle)},
                      {"upper", "", low, high}};
    KeyDefinition end = test::bend_key(0.15, 0);
    end.translation = {-radii * r, 0, 0};
    settings.tracks = {test::track("upper", {test::bend_key(0, 0), end})};
  }

  /// Between the bars, N, and the fraction of them that is grouped.
  Pressed pressed(bool enabled) const {
    Settings given = settings;
    given.hierarchy.enabled = enabled;
    Simulation simulation = test::make_simulation(given, rest);
    while (simulation.time() < settings.solver.duration) simulation.step();
    const auto& grouping = simulation.body().grouping;
    return {
        simulation.reactions_of_bones().springs[0].force.norm(),
        grouping ? static_cast<double>(grouping->grouped()) / static_cast<double>(rest.size()) : 0};
  }
};

TEST(TouchingBodies, ForcesAreThoseWithoutGroups) {
  const Crossed crossed(3);
  const double alone = crossed.pressed(false).force;
  ASSERT_GT(alone, 1);
  const Pressed grouped = crossed.pressed(true);
  EXPECT_NEAR(grouped.force, alone, 0.05 * alone);
  EXPECT_GT(grouped.grouped, 0.1);
}

TEST(TouchingBodies, AreWholeWhereTheyDoNotMeet) {
  EXPECT_GT(Crossed(-3).pressed(true).grouped, 0.99);
  Settings one = test::box_scene(height);
  one.tracks = {test::track("upper", {test::bend_key(0, 0), test::bend_key(1, 120)})};
  const Prepared bent = prepared(one, false);
  EXPECT_TRUE(touching_bodies(bent.body, bent.motion, 1).empty());
}

std::vector<std::uint8_t> near(const Settings& settings) {
  const Prepared made = prepared(settings, false);
  return near_obstacles(made.body, made.motion, settings.solver.duration);
}

/// A ball slides along the side and touches it nowhere: a quarter of the width around it is free.
TEST(NearObstacles, WhatAnObstacleSweepsIsFree) {
  const Vec3 from(side + 6 * r, 0, 20 * s), to(side + 6 * r, 0, 60 * s);
  ObstacleSettings obstacle = ball(from, 4 * r);
  obstacle.keys = {moved_to(0, Vec3::Zero()), moved_to(0.15, to - from)};
  const Settings settings = bar_with(obstacle);
  const double across = std::sqrt(prepared(settings, false).body.binding.cross_section[0]);
  const auto marks = near(settings);
  const Points places = rest();
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double distance = signed_distance(CapsuleShape{from, to, 4 * r}, places[i]).distance - r;
    EXPECT_TRUE(marks[i] == 1 || distance > 0.24 * across) << i;
    EXPECT_TRUE(marks[i] == 0 || distance < 0.5 * across) << i;
  }
}

TEST(NearObstacles, TheWiderTheContactTheMoreIsFree) {
  std::size_t before = 0;
  for (const double radius : {2 * r, 4 * r, 8 * r}) {
    const auto marks = near(bar_with(ball({side + radius, 0, 0.5 * top}, radius)));
    const auto free = static_cast<std::size_t>(std::count(marks.begin(), marks.end(), 1));
    EXPECT_GT(free, before + 100);
    EXPECT_LT(free, marks.size() / 2);
    before = free;
  }
}

TEST(NearObstacles, WhatBonesCarryToAnObstacleIsFree) {
  Settings settings = leaning_on_a_post();
  const auto at_the_post = [&](const std::vector<std::uint8_t>& marks) {
    const Points places = rest();
    std::size_t count = 0;
    for (std::size_t i = 0; i < places.size(); ++i)
      count += marks[i] == 1 && places[i].x() > side - r && places[i].z() > 0.8 * top &&
               places[i].z() < 0.9 * top;
    return count;
  };
  EXPECT_GT(at_the_post(near(settings)), 50U);
  settings.tracks.clear();
  EXPECT_EQ(at_the_post(near(settings)), 0U);
  settings.world.obstacles[0].center = Vec3(side + 5 * r, 0, 0.85 * top);
  settings.world.obstacles[0].bone = "upper";  // rides at its place
  settings.tracks = leaning_on_a_post().tracks;
  EXPECT_GT(at_the_post(near(settings)), 50U);
}

TEST(NearObstacles, NothingIsMarkedWithoutThem) {
  Settings settings = leaning_on_a_post();
  settings.world.obstacles[0].center = Vec3(5, 0, 0);
  const auto far = near(settings);
  EXPECT_EQ(std::count(far.begin(), far.end(), 1), 0);
  settings.world.obstacles.clear();
  EXPECT_TRUE(near(settings).empty());
}

/// Bones carry it nowhere near, but its weight does.
TEST(NearObstacles, OneThatReachesAGroupEndsTheRun) {
  for (const bool dynamic : {false, true}) {
    Settings settings = bar_with({});
    settings.world.obstacles[0].name = "floor";
    settings.world.obstacles[0].point = Vec3(0, 0, -10.5 * r);
    settings.solver.gravity = {0, 0, -10};
    settings = test::unbound(settings);
    Simulation simulation = start(prepared(settings, true, dynamic));
    const auto run = [&] {
      while (simulation.time() < settings.solver.duration) simulation.step();
    };
    test::expect_error(Exit::unstable, run,
                       {"obstacle 'floor' reached a group", "hierarchy.free_region", "free_bones",
                        "surface_distance", "set hierarchy.enabled to false"});
  }
}

TEST(NearObstacles, GroupsThatChangeRefuseThoseOfParticlesThatNoBoneHolds) {
  test::expect_bad_input([&] { prepared(held_in_its_core(), true, true); },
                         {"hierarchy.dynamic", "obstacle 'ball'", "no bone holds", "; set "});
}

}  // namespace
}  // namespace sinew::near_obstacles_test

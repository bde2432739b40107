// SPDX-License-Identifier: GPL-3.0-or-later
// Groups that change while a body moves.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include <sinew/core/parallel.h>
#include <sinew/groups/dynamic/dynamic_groups.h>
#include <sinew/stepping/detail/dynamic_grouping.h>

#include "support/expect_error.h"
#include "support/grouped_bar.h"

namespace sinew::dynamic_groups_test {

using namespace groups_test;
namespace {

constexpr int width = 17, height = 97;
const DynamicOptions options{{.joint_distance = 0.7, .min_particles = 256}, 0.03};
const DynamicOptions bending_ones{
    {.joint_distance = 0.7, .min_particles = 256, .cubic_distance = 0.5, .min_cubic = 1024}, 0.03};
// Beyond the time for which the first groups are made.
constexpr double start = 0.3, bent = 0.4;

/// The upper half of a bar bends by 20 degrees from `start` until `bent`, and back until `back`.
Bar swinging(MaterialModel model, Precision precision = Precision::binary64, double back = 10) {
  Settings settings = test::in(precision, test::box_scene(height));
  settings.material.model = model;
  settings.material.damping_form = DampingForm::paper;
  settings.material.young_modulus = 1e5;
  settings.tracks = {test::track(
      "upper", {test::bend_key(start, 0), test::bend_key(bent, 20), test::bend_key(back, 0)})};
  return Bar(settings, width, height, [](const Vec3&) { return -1; });
}

Simulation begin(const Bar& bar, const DynamicOptions& by = options) {
  Simulation simulation = bar.begin();
  simulation.enable_dynamic_groups(by);
  return simulation;
}

double grouped_fraction(const Simulation& simulation) {
  const Grouping& grouping = *simulation.body().grouping;
  return static_cast<double>(grouping.grouped()) / static_cast<double>(grouping.group.size());
}

TEST(DynamicGroups, ABodyIsOneUntilAJointMoves) {
  const Bar bar = swinging(MaterialModel::bonded);
  Simulation simulation = begin(bar);
  EXPECT_EQ(simulation.body().grouping->size(), 1U);
  EXPECT_EQ(grouped_fraction(simulation), 1);
  while (simulation.time() < 0.5 * start) simulation.step();
  EXPECT_EQ(grouped_fraction(simulation), 1);
  while (simulation.time() < start) simulation.step();
  const Grouping& grouping = *simulation.body().grouping;
  EXPECT_EQ(grouping.size(), 2U);
  EXPECT_GT(grouped_fraction(simulation), 0.2);
  const double joint = bar.body.skeleton.bones[1].head().z();
  const double free = options.sizes.joint_distance * std::sqrt(bar.body.binding.cross_section[1]);
  for (std::size_t i = 0; i < bar.rest.size(); ++i)
    EXPECT_TRUE(grouping.group[i] < 0 || std::abs(bar.rest[i].z() - joint) >= free) << i;
}

/// States from elsewhere, whose checksums are right.
TEST(DynamicGroups, StatesOfOtherSkeletonsAreRefused) {
  const Bar bar = swinging(MaterialModel::bonded);
  Simulation simulation = begin(bar);
  for (int k = 0; k < 20; ++k) simulation.step();
  const SimulationState good = simulation.save();
  const std::vector<std::function<void(RegroupingState&)>> forgeries = {
      [](auto& state) { state.still_since.clear(); },
      [](auto& state) { state.still_since.resize(1000, 1); },
      [](auto& state) { state.still_since[0] = std::nan(""); },
      [](auto& state) { state.times = -1; }, [](auto& state) { state.lost = std::nan(""); }};
  for (const auto& forge : forgeries) {
    SimulationState state = good;
    auto regrouping = part_of<RegroupingState>(state, "regrouping");
    forge(regrouping);
    put_part(state, "regrouping", regrouping);
    test::expect_bad_input([&] { begin(bar).restore(state); }, {"another skeleton"});
  }
  begin(bar).restore(good);
}

TEST(DynamicGroups, WhatHasComeBackJoinsAgain) {
  Simulation simulation = begin(swinging(MaterialModel::bonded, Precision::binary64, 0.5));
  double least = 1;
  while (simulation.time() < 1.2) {
    simulation.step();
    least = std::min(least, grouped_fraction(simulation));
  }
  EXPECT_LT(least, 0.8);
  EXPECT_GT(grouped_fraction(simulation), 0.9);
}

struct Bend {
  double off;  ///< from a run without groups, root mean square in radii
  std::size_t grouped, cubic;
};

Bend bend_of(const Bar& bar, const DynamicOptions& by) {
  Simulation full = bar.begin(), grouped = begin(bar, by);
  while (full.time() < bent + 0.05) full.step(), grouped.step();
  const Grouping& grouping = *grouped.body().grouping;
  return {root_mean_square_distance(full.particles(), grouped.particles()) / r, grouping.grouped(),
          static_cast<std::size_t>(
              std::count(grouping.cubic.begin(), grouping.cubic.end(), std::uint8_t{1}))};
}

TEST(DynamicGroups, ABendIsNearlyTheSame) {
  for (const MaterialModel model : models) EXPECT_LT(bend_of(swinging(model), options).off, 0.3);
}

TEST(DynamicGroups, CubicOnesBendWhereAffineOnesSplit) {
  const Bar bar = swinging(MaterialModel::bonded);
  const Bend affine = bend_of(bar, options), cubic = bend_of(bar, bending_ones);
  EXPECT_EQ(affine.cubic, 0U);
  EXPECT_EQ(cubic.cubic, 2U);
  EXPECT_GT(cubic.grouped, affine.grouped);
  EXPECT_LT(cubic.off, 0.3);
}

TEST(DynamicGroups, TheLedgerClosesWithWhatMergingLoses) {
  for (const DynamicOptions& by : {options, bending_ones}) {
    Simulation simulation = begin(swinging(MaterialModel::bonded, Precision::binary64, 0.5), by);
    const double before = simulation.energies().stored();
    while (simulation.time() < 1) simulation.step();
    const Energies now = simulation.energies();
    EXPECT_GT(simulation.regroupings(), 2);
    EXPECT_NEAR(now.stored() - before, now.work() - now.dissipation, 0.01 * now.work_of_bones);
    EXPECT_LT(std::abs(simulation.lost_by_merging()), 0.01 * now.work_of_bones);
  }
}

/// On one thread, and on three with saves on the way.
void expect_the_same_bits(const Bar& bar, const DynamicOptions& by) {
  std::vector<std::uint64_t> hashes;
  for (const int threads : {1, 3})
    with_threads(threads, [&] {
      Simulation simulation = begin(bar, by);
      while (simulation.time() < start + 0.03) {
        simulation.step();
        if (threads == 1 || simulation.steps() % 57 != 0) continue;
        Simulation resumed = begin(bar, by);
        resumed.restore(simulation.save());
        simulation = std::move(resumed);
      }
      hashes.push_back(state_hash(simulation.particles()));
    });
  EXPECT_EQ(hashes[0], hashes[1]);
}

TEST(DynamicGroups, TheSameBitsOnAnyNumberOfThreadsAndAfterASave) {
  for (const Precision precision : test::precisions)
    for (const DynamicOptions& by : {options, bending_ones})
      expect_the_same_bits(swinging(MaterialModel::bonded, precision), by);
}

/// A bar without bones that flies, deformed as a whole by 1 %.
Bar flying(MaterialModel model) {
  Settings settings = test::unbound(scene_of(model, DampingForm::central));
  Bar bar(settings, width, height, [](const Vec3&) { return -1; });
  const Vec3 spin(0.1, -0.2, 0.4), velocity(0.1, 0, 0.3);
  for (std::size_t i = 0; i < bar.rest.size(); ++i)
    bar.particles.set_velocity(i, velocity + spin.cross(bar.rest[i]));
  return bar;
}

TEST(DynamicGroups, KeepMomentumWhereTheyChange) {
  for (const MaterialModel model : models) {
    Bar bar = flying(model);
    // One half is faster, and waves go through the bar.
    for (std::size_t i = 0; i < bar.rest.size(); ++i)
      if (bar.rest[i].z() > 48 * half_plane_spacing(r)) bar.particles.w[i] += 0.05;
    Simulation simulation = begin(bar);
    const Conserved before = conserved(simulation.particles());
    while (simulation.steps() < 1600) simulation.step();
    const Conserved after = conserved(simulation.particles());
    const double scale = static_cast<double>(bar.rest.size());
    EXPECT_GT(simulation.regroupings(), 1);
    EXPECT_LT((after.momentum - before.momentum).norm(), 1e-12 * scale);
    EXPECT_LT((after.angular - before.angular).norm(),
              1e-4 * scale * bounds(bar.rest).sizes().norm());
  }
}

TEST(DynamicGroups, RefuseWhatTheyCannotBeCombinedWith) {
  Bar bar = flying(MaterialModel::bonded);
  bar.settings.solver.neighbor_search = NeighborSearch::cells;
  bar.body.grouping.reset();
  Simulation cells = bar.begin();
  test::expect_bad_input([&] { cells.enable_dynamic_groups(options); },
                         {"the paper's cells and groups of particles"});
}

TEST(DynamicGroups, RefuseObstaclesOfBodiesWithoutBones) {
  Bar bar = flying(MaterialModel::bonded);
  World world;
  world.obstacles.emplace_back().name = "floor";
  bar.body.world = std::make_shared<const World>(world);
  bar.body.grouping.reset();
  bar.body.binding = {};
  bar.body.binding.first.assign(bar.rest.size() + 1, 0);
  Simulation simulation = bar.begin();
  test::expect_bad_input([&] { simulation.enable_dynamic_groups(options); },
                         {"obstacle 'floor'", "no bone holds", "; set hierarchy.dynamic to false"});
}

TEST(DynamicGroups, RefuseAnotherMotion) {
  const Bar bar = swinging(MaterialModel::bonded);
  Simulation simulation = begin(bar);
  const auto play = [&] { simulation.play(motion_of(bar.settings, bar.body.skeleton)); };
  for (const int steps : {0, 3}) {
    while (simulation.steps() < steps) simulation.step();
    test::expect_bad_input(play, {"groups of particles", "; set hierarchy.enabled to false"});
  }
}

}  // namespace
}  // namespace sinew::dynamic_groups_test

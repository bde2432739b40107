// SPDX-License-Identifier: GPL-3.0-or-later
// Limbs that are driven through each other: contact between those that meet, none between those
// that pass.
#include <sinew/core/error.h>
#include <sinew/groups/make_grouping.h>

#include "support/both_steppers.h"
#include "support/expect_error.h"

namespace sinew::pass_through_test {

using namespace both_steppers;

constexpr double apart = 0.13, height = 11 * 0.01414213562;  // m

/// Three bars on bones of their own, upright and side by side: left, right and, behind both, third.
Points three_bars() {
  const Points bar = test::fcc_box(5, 5, 11, r);
  Points all;
  for (const Vec3& shift : {Vec3(0, 0, 0), Vec3(apart, 0, 0), Vec3(0, apart, 0)})
    for (const Vec3& point : bar) all.push_back(point + shift);
  return all;
}

enum class Model { paper, sticking_at_rest, bonded, bonded_volume };
constexpr Model models[] = {Model::paper, Model::sticking_at_rest, Model::bonded,
                            Model::bonded_volume};

/// The right bar moves through the left one within 0.4 s, by `shift` along x.
Settings crossing(Model model, double shift = -2 * apart) {
  Settings settings;
  settings.body.radius = r;
  settings.bones = {{"left", "", Vec3(0, 0, 0), Vec3(0, 0, height)},
                    {"right", "", Vec3(apart, 0, 0), Vec3(apart, 0, height)},
                    {"third", "", Vec3(0, apart, 0), Vec3(0, apart, height)}};
  KeyDefinition begin, end;
  begin.time = 0, end.time = 0.4;
  end.translation = {shift, 0, 0};
  settings.tracks = {test::track("right", {begin, end})};
  if (model == Model::sticking_at_rest) settings.material.cohesion = Cohesion::initial_neighbors;
  if (model == Model::bonded) settings.material.model = MaterialModel::bonded;
  if (model == Model::bonded_volume) settings.material.model = MaterialModel::bonded_volume;
  return settings;
}

Settings passing(Settings settings) {
  settings.contact.pass_through.pairs = {{"right", "left"}};
  return settings;
}

/// The largest displacement of particles [begin, end) from rest, in radii.
double moved(const Particles& particles, const Points& rest, std::size_t begin, std::size_t end) {
  double most = 0;
  for (std::size_t i = begin; i < end; ++i)
    most = std::max(most, (particles.position(i) - rest[i]).norm() / r);
  return most;
}

std::size_t inverted(const Particles& particles, const Points& rest) {
  const RestShape shape = rest_shape(rest, rest_neighbor_range(r));
  std::size_t count = 0;
  for (const Mat3& F : test::deformation_gradients(shape, positions_of(particles)))
    count += F.determinant() <= 0 ? 1 : 0;
  return count;
}

TEST(PassThrough, LimbsExertNoForceOnEachOtherAndStayWhole) {
  const Points rest = three_bars();
  const std::size_t bar = rest.size() / 3;
  for (const Model model : models) {
    SCOPED_TRACE(static_cast<int>(model));
    Simulation through = test::make_simulation(passing(crossing(model)), rest);
    while (through.time() < 0.2) through.step();  // in the middle of the other
    EXPECT_LT(moved(through.particles(), rest, 0, bar), 1e-6);
    while (through.time() < 0.6) through.step();
    EXPECT_LT(moved(through.particles(), rest, 0, bar), 1e-6);
    EXPECT_EQ(inverted(through.particles(), rest), 0U);
    Points there = rest;
    for (std::size_t i = bar; i < 2 * bar; ++i) there[i].x() -= 2 * apart;
    EXPECT_LT(moved(through.particles(), there, bar, 2 * bar), 0.01);
    // Without, the left bar is pushed.
    Simulation against = test::make_simulation(crossing(model, -apart / 2), rest);
    while (against.time() < 0.45) against.step();
    EXPECT_GT(moved(against.particles(), rest, 0, bar), 0.1);
  }
}

TEST(PassThrough, OtherPairsOfBonesMeetAsAlways) {
  const Points rest = three_bars();
  const std::size_t bar = rest.size() / 3;
  Settings settings = crossing(Model::bonded, -apart / 2);
  settings.contact.pass_through.pairs = {{"right", "third"}};
  Simulation simulation = test::make_simulation(settings, rest);
  while (simulation.time() < 0.45) simulation.step();
  Simulation without = test::make_simulation(crossing(Model::bonded, -apart / 2), rest);
  while (without.time() < 0.45) without.step();
  EXPECT_GT(moved(simulation.particles(), rest, 0, bar), 0.1);
  for (std::size_t i = 0; i < rest.size(); ++i)
    EXPECT_EQ(simulation.particles().position(i), without.particles().position(i)) << i;
}

TEST(PassThrough, BalanceAndMomentumAreKept) {
  const Points rest = three_bars();
  for (const Model model : models) {
    SCOPED_TRACE(static_cast<int>(model));
    // The right bar goes half into the left one, and the left one leans towards the third.
    Settings settings = passing(crossing(model, -0.8 * apart));
    settings.tracks.push_back(test::track("left", {test::bend_key(0, 0), test::bend_key(0.3, 30)}));
    Simulation simulation = test::make_simulation(settings, rest);
    const double start = simulation.energies().stored();
    while (simulation.time() < 0.4) simulation.step();
    const Energies end = simulation.energies();
    EXPECT_LT(std::abs(end.stored() - start - end.work_of_bones + end.dissipation),
              0.01 * std::abs(end.work_of_bones));
    Vec3 sum = Vec3::Zero();
    for (const Vec3& force : simulation.forces().pair) sum += force;
    const double scale = simulation.body().material.stiffness() * r;
    EXPECT_LT(sum.norm(), 1e-10 * scale);
  }
}

/// The bars as their bones begin: right half in left, third touching left.
struct Overlapping {
  Points rest = three_bars(), close = rest;
  Settings settings;

  explicit Overlapping(Model model) : settings(passing(crossing(model))) {
    const Vec3 right(-0.1, 0, 0), third(0, 0.0746 - apart, 0);
    settings.tracks[0].keys[0].translation = right;
    KeyDefinition stays;
    stays.time = 0;
    stays.translation = third;
    settings.tracks.push_back(test::track("third", {stays}));
    const std::size_t bar = rest.size() / 3;
    for (std::size_t i = bar; i < rest.size(); ++i) close[i] += i < 2 * bar ? right : third;
  }

  Particles begin(const Body& body) const {
    return test::shaken(close, body.material, 0.02 * r, 0.05);
  }
};

TEST(PassThrough, ListsAndCellsAgree) {
  for (const Model model : models) {
    SCOPED_TRACE(static_cast<int>(model));
    const Overlapping bars(model);
    const Body body = test::make_body(bars.settings, bars.rest);
    Both both(bars.settings, bars.rest, bars.begin(body), test::step_of(bars.settings, body));
    for (const int steps : {0, 1, 10, 60}) {
      SCOPED_TRACE(steps);
      both.step_until(steps);
      expect_same(both, steps > 10 ? 1e-9 : 1e-11);
    }
  }
}

TEST(PassThrough, SinglePrecisionAndEveryInstructionSetAgree) {
  for (const Model model : {Model::paper, Model::bonded})
    for (const Precision precision : test::precisions) {
      const Overlapping bars(model);
      const Body body = test::make_body(bars.settings, bars.rest);
      const double step = test::step_of(bars.settings, body);
      const auto run = [&](kernel::InstructionSet set, Precision of) {
        Simulation simulation = test::simulation_with(set, test::in(of, bars.settings), bars.rest,
                                                      bars.begin(body), step);
        simulation.advance(40);
        return simulation.take_particles();
      };
      const auto sets = test::instruction_sets();
      const Particles first = run(sets.front(), precision);
      for (const auto set : sets) EXPECT_EQ(test::largest_distance(first, run(set, precision)), 0);
      EXPECT_LT(test::largest_distance(first, run(sets.front(), Precision::binary64)), 1e-3 * r);
    }
}

TEST(PassThrough, WhatIsNearAtRestActsAsAlways) {
  for (const MaterialModel model : {MaterialModel::paper, MaterialModel::bonded}) {
    Settings settings = test::box_scene(25);
    settings.material.model = model;
    settings.tracks = {test::track("upper", {test::bend_key(0, 0), test::bend_key(0.5, 30)})};
    Settings split = settings;
    split.contact.pass_through.pairs = {{"lower", "upper"}};
    const Points rest = test::fcc_box(7, 7, 25, r);
    Simulation whole = test::make_simulation(settings, rest),
               other = test::make_simulation(split, rest);
    whole.advance(100), other.advance(100);  // as long as nothing else meets
    EXPECT_GT(moved(whole.particles(), rest, 0, rest.size()), 0.05);
    EXPECT_EQ(test::largest_distance(whole.particles(), other.particles()), 0);
  }
}

TEST(PassThrough, FrictionPassesAsWell) {
  Settings settings = passing(crossing(Model::bonded));
  settings.material.friction = 0.5;
  const Points rest = three_bars();
  Simulation through = test::make_simulation(settings, rest);
  while (through.time() < 0.2) through.step();
  EXPECT_LT(moved(through.particles(), rest, 0, rest.size() / 3), 1e-6);
}

TEST(PassThrough, BonesThatAreNotThereAndGroupsAreRefused) {
  const Points rest = three_bars();
  Settings settings = crossing(Model::bonded);
  settings.contact.pass_through.pairs = {{"left", "rihgt"}};
  test::expect_bad_input([&] { test::make_body(settings, rest); }, {"rihgt", "right"});
  settings.contact.pass_through.pairs = {{"left", "left"}};
  test::expect_bad_input([&] { test::make_body(settings, rest); }, {"paired with itself"});
  Body body = test::make_body(passing(crossing(Model::bonded)), rest);
  test::expect_bad_input([&] { check_groupable(body); }, {"passes through", "groups of particles"});
}

}  // namespace sinew::pass_through_test

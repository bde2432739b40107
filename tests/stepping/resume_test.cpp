// SPDX-License-Identifier: GPL-3.0-or-later
// A simulation that is saved and restored continues with the bits of one that never stopped,
// wherever it stops and on any number of threads, while particles are sorted and units chosen
// again.
#include <sinew/body/ledger.h>
#include <sinew/core/parallel.h>
#include <sinew/scene/prepare.h>
#include <sinew/scene/rig.h>
#include <sinew/world/world.h>

#include "support/all_steppers.h"
#include "support/expect_error.h"

namespace sinew::resume_test {

constexpr double r = 0.01;

/// A world from which any number of equal simulations can be started.
struct World {
  std::string name;
  Settings settings;
  Points rest;
  double shake = 0, speed = 0;  // of the particles at the beginning: radii, m/s
  double factor = 0.5;
  Vec3 velocity = Vec3::Zero();
  std::shared_ptr<const sinew::World> around = {};
  std::vector<int> parts = {};  // of the steps, by intervals of 37 of them

  Simulation begin() const {
    Body body = test::make_body(settings, rest);
    Particles particles = test::shaken(rest, body.material, shake * r, speed);
    for (std::size_t i = 0; i < particles.size(); ++i)
      particles.set_velocity(i, particles.velocity(i) + velocity);
    const double step = test::step_of(settings, body, factor);
    body.world = around;
    Simulation simulation(body, motion_of(settings, body.skeleton), particles,
                          stepping_of(settings.solver, step));
    simulation.follow(parts.empty() ? StepPlan(step)
                                    : StepPlan(step, 37, parts, WholeSteps{11, 0.9 * step}));
    return simulation;
  }
};

void PrintTo(const World& world, std::ostream* out) { *out << world.name; }

World bend(const std::string& name, Precision precision, int planes = 25) {
  World world{name, test::in(precision, test::box_scene(planes)), test::fcc_box(7, 7, planes, r)};
  world.settings.binding.joint_zone = 2;
  world.settings.solver.gravity = {0, 1, -2};
  world.settings.tracks = {test::track("upper", {test::bend_key(0, 0), test::bend_key(0.2, 50)})};
  return world;
}

/// Begins in no order, off the lattice, and flows.
World melt(const std::string& name, Precision precision) {
  World world{name,
              test::in(precision, test::unbound(test::box_scene(15))),
              test::affine(test::fcc_box(13, 13, 15, r), test::turned(Vec3::UnitZ(), 20)),
              0.3,
              1.2,
              0.1};
  world.settings.material.damping = 0;
  std::shuffle(world.rest.begin(), world.rest.end(), std::mt19937(7));
  return world;
}

/// Flies so far that fixed-point units must be chosen again.
World flight(const std::string& name) {
  World world{name,
              test::in(Precision::binary32, test::unbound(test::box_scene(9))),
              test::fcc_box(5, 5, 9, r),
              0.1,
              0.1,
              0.1};
  world.velocity = {3, -2, 1};
  return world;
}

World with(World world, Integrator integrator) {
  world.settings.solver.integrator = integrator;
  return world;
}

World with(World world, NeighborSearch search) {
  world.settings.solver.neighbor_search = search;
  return world;
}

/// Bonds that creep and snap.
World tearing(const std::string& name, MaterialModel model) {
  World world = bend(name, Precision::binary64, 17);
  world.settings.material.model = model;
  world.settings.material.breaking_strain = 0.02;
  world.settings.material.yield_strain = 0.005;
  world.settings.material.creep_rate = 30;
  world.settings.material.relaxation_shares = {0.2, 0.1};
  world.settings.material.relaxation_times = {0.002, 0.5};
  world.shake = 0.05;
  return world;
}

/// Steps are divided for a while, twice, and a last interval is shorter than the others.
World divided(const std::string& name, World world) {
  world.name = name;
  world.parts = {1, 4, 3, 1, 1, 12, 1};
  return world;
}

World in(Precision precision, World world) {
  world.settings.solver.precision = precision;
  return world;
}

/// A roller, a grip that lifts, a force that grows and a pressure.
void grip(const Points& rest, sinew::World& around) {
  const auto middle = static_cast<std::uint32_t>(rest.size() / 2);
  Support roller{"roller", {middle}, {true, false, false}}, lift{"lift", {middle + 9}};
  lift.pivot = rest[middle];
  lift.motion = [at = lift.pivot](double time, const Pose&) {
    return ObstaclePose{{at + time * Vec3(0, 0, 0.01), Mat3::Identity()}, {0, 0, 0.01}, {0, 0, 0}};
  };
  around.supports = {roller, lift};
  hold(around, rest.size());
  const Vec3 side(3 * r, 0, 0), up(0, 0, 4 * r);
  const Triangles sheet{{rest[middle] - side, rest[middle] + side, rest[middle] + up}, {{0, 1, 2}}};
  around.loads = {force_load("pull", {middle + 20}, {1}, {0, 0.01, 0}, rest),
                  pressure_load("press", sheet, 300, rest, r)};
  around.loads[0].scale = {{0, 0.05}, {0, 1}};
}

/// Between an approaching wall and a wind, in a medium, held at both ends, with a muscle that
/// twitches, in a testing machine.
World surrounded(const std::string& name, Integrator integrator) {
  World world = with(bend(name, Precision::binary64, 17), integrator);
  const Material material = test::material_of(world.settings);
  sinew::World around;
  Obstacle wall;
  wall.name = "wall";
  wall.shape = PlaneShape{{-5.4 * r, 0, 0}, {1, 0, 0}};
  wall.motion = [](double time, const Pose&) {
    return ObstaclePose{{{0.005 * time, 0, 0}, Mat3::Identity()}, {0.005, 0, 0}, Vec3::Zero()};
  };
  wall.stiffness = material.pair.contact_stiffness();
  wall.damping = 0.5 * std::sqrt(wall.stiffness * material.mass);
  wall.friction = 0.4;
  around.obstacles = {wall};
  around.drag.rate = 2;
  around.fields = {{"wind", UniformAcceleration{{2, 0, 0}}, {}, {{0, 0.02}, {0, 1}}}};
  const double top = world.rest.back().z();
  around.pins = pinned(world.rest,
                       {{{BoxShape{{0, 0, 0}, {1, 1, 2 * r}}, 0}, no_bone},
                        {{BoxShape{{0, 0, top}, {1, 1, 2 * r}}, 0}, 1}},
                       2);
  Muscle muscle;
  muscle.strength = 200;
  muscle.activation = {{0, 0.05}, {0, 1}};
  muscle.weights = weights_in({}, world.rest);
  around.muscles = make_muscles(world.rest, r, {muscle});
  grip(world.rest, around);
  world.around = std::make_shared<const sinew::World>(around);
  world.factor = 0.2;
  return world;
}

std::vector<World> worlds() {
  using enum Precision;
  return {
      bend("BendInDouble", binary64),
      bend("BendInSingle", binary32),
      with(bend("VerletInDouble", binary64), Integrator::velocity_verlet),
      with(bend("VerletInSingle", binary32), Integrator::velocity_verlet),
      with(bend("ExplicitInSingle", binary32), Integrator::explicit_euler),
      melt("MeltInDouble", binary64),
      melt("MeltInSingle", binary32),
      flight("Flight"),
      with(bend("Cells", binary64, 17), NeighborSearch::cells),
      with(with(bend("VerletWithCells", binary64, 17), NeighborSearch::cells),
           Integrator::velocity_verlet),
      tearing("Bonded", MaterialModel::bonded),
      tearing("BondedVolume", MaterialModel::bonded_volume),
      in(binary32, tearing("BondedInSingle", MaterialModel::bonded)),
      in(binary32, tearing("BondedVolumeInSingle", MaterialModel::bonded_volume)),
      with(tearing("BondedInCells", MaterialModel::bonded_volume), NeighborSearch::cells),
      surrounded("Surrounded", Integrator::symplectic_euler),
      in(binary32, surrounded("SurroundedInSingle", Integrator::symplectic_euler)),
      with(surrounded("SurroundedInCells", Integrator::symplectic_euler), NeighborSearch::cells),
      surrounded("VerletSurrounded", Integrator::velocity_verlet),
      divided("DividedInDouble", bend("", binary64)),
      divided("DividedInSingle", bend("", binary32)),
      divided("DividedVerlet", with(bend("", binary64), Integrator::velocity_verlet)),
      divided("DividedTearing", tearing("", MaterialModel::bonded_volume)),
      divided("DividedTearingInSingle", in(binary32, tearing("", MaterialModel::bonded))),
      divided("DividedInCells", with(bend("", binary64, 17), NeighborSearch::cells)),
      divided("DividedAndSurrounded", surrounded("", Integrator::symplectic_euler))};
}

/// All results of a simulation at one moment.
struct Results {
  std::uint64_t state = 0;
  std::vector<double> energies;
  Points forces;
  std::vector<int> neighbors;
  std::vector<std::int32_t> broken;

  bool operator==(const Results&) const = default;
};

Results results_of(Simulation& simulation) {
  const Energies of = simulation.energies();
  const Forces& forces = simulation.forces();
  Results results{state_hash(simulation.particles()),
                  {of.kinetic, of.gravity, of.pair, of.bone, of.work_of_bones, of.dissipation,
                   of.contact, of.work_of_world},
                  {},
                  forces.neighbors,
                  simulation.broken_bonds()};
  for (std::size_t i = 0; i < simulation.particles().size(); ++i)
    for (const auto* part : {&forces.pair, &forces.damping, &forces.bone})
      results.forces.push_back((*part)[i]);
  results.forces.insert(results.forces.end(), forces.world.begin(), forces.world.end());
  for (const auto& all : {simulation.reactions_of_obstacles(), simulation.support_reactions(),
                          simulation.load_reactions()})
    for (const Reaction& on : all) {
      results.forces.push_back(on.force);
      results.forces.push_back(on.moment);
      results.energies.push_back(on.power);
    }
  return results;
}

/// Saving the state during a run changes nothing.
bool is_told(std::int64_t step) { return step % 5 == 0; }

void go_on(Simulation& simulation, std::int64_t steps) {
  while (simulation.steps() < steps) {
    simulation.step();
    if (is_told(simulation.steps())) simulation.energies();
  }
}

class Resumed : public testing::TestWithParam<World> {};

/// Past the first check of the order of the particles.
constexpr std::int64_t last = 1100;

TEST_P(Resumed, GoesOnWithTheBitsOfAnUnbrokenRunOnAnyNumberOfThreads) {
  Simulation unbroken = GetParam().begin();
  std::vector<SimulationState> saved{unbroken.save()};
  for (const std::int64_t moment : {1, 2, 37, 301, 820, 1023, 1024, 1025}) {
    go_on(unbroken, moment);
    saved.push_back(unbroken.save());
  }
  while (unbroken.steps() < last) unbroken.step();
  const Results expected = results_of(unbroken);
  int threads = 0;
  for (const SimulationState& state : saved)
    with_threads(1 + threads++ % 3, [&] {
      Simulation resumed = GetParam().begin();
      resumed.restore(state);
      EXPECT_EQ(resumed.steps(), state.steps);
      while (resumed.steps() < last) resumed.step();
      EXPECT_TRUE(results_of(resumed) == expected) << "from step " << state.steps;
    });
}

TEST_P(Resumed, GivesTheSameResultsAtTheMomentItWasSavedAt) {
  Simulation simulation = GetParam().begin();
  for (const std::int64_t moment : {0, 3, 90}) {
    go_on(simulation, moment);
    const SimulationState state = simulation.save();
    const Results expected = results_of(simulation);
    Simulation resumed = GetParam().begin();
    resumed.restore(state);
    EXPECT_TRUE(results_of(resumed) == expected) << "step " << moment;
  }
}

TEST_P(Resumed, StopsAgainAndAgainWithoutATrace) {
  Simulation unbroken = GetParam().begin();
  auto resumed = std::make_unique<Simulation>(GetParam().begin());
  while (unbroken.steps() < 200) {
    unbroken.step();
    resumed->step();
    if (unbroken.steps() % 17 != 0) continue;
    const SimulationState state = resumed->save();
    resumed = std::make_unique<Simulation>(GetParam().begin());
    resumed->restore(state);
  }
  EXPECT_TRUE(results_of(*resumed) == results_of(unbroken));
}

INSTANTIATE_TEST_SUITE_P(Worlds, Resumed, testing::ValuesIn(worlds()),
                         [](const auto& one) { return one.param.name; });

TEST(Resume, GoesThroughSortsUnitsAndBrokenBonds) {
  for (const Precision precision : test::precisions) {
    Simulation simulation = melt("Melt", precision).begin();
    const auto before = simulation.save().order;
    while (simulation.steps() < last) simulation.step();
    EXPECT_GT(simulation.list_counts().sorts, 0);
    EXPECT_NE(simulation.save().order, before);
  }
  Simulation far = flight("Flight").begin();
  const Vec3 origin = far.save().fixed_point_units.origin;
  while (far.steps() < last) far.step();
  EXPECT_NE(far.save().fixed_point_units.origin, origin);
  Simulation torn = tearing("Torn", MaterialModel::bonded).begin();
  while (torn.steps() < last) torn.step();
  Simulation pressed = surrounded("Pressed", Integrator::symplectic_euler).begin();
  while (pressed.steps() < last) pressed.step();
  EXPECT_GT(pressed.energies().contact, 0);
  EXPECT_NE(pressed.energies().work_of_world, 0);
  const auto broken = torn.broken_bonds();
  EXPECT_GT(std::count_if(broken.begin(), broken.end(), [](int n) { return n > 0; }), 0);
}

TEST(Resume, ParticlesThatComeTogetherInAnotherOrderAreSortedAgain) {
  const World world = melt("", Precision::binary64);
  const Body body = test::make_body(world.settings, world.rest);
  const double step = test::step_of(world.settings, body, world.factor);
  Points start = world.rest;  // of a thin cloud
  std::shuffle(start.begin(), start.end(), std::mt19937(8));
  Particles particles = particles_at(world.rest, r, body.material.mass);
  for (std::size_t i = 0; i < start.size(); ++i) {
    particles.set_position(i, 4 * start[i]);
    particles.set_velocity(i, (world.rest[i] - 4 * start[i]) / (1000 * step));
  }
  Simulation simulation = test::simulation_from(world.settings, world.rest, particles, step);
  simulation.step();
  const std::int64_t of_the_cloud = simulation.list_counts().sorts;
  while (simulation.steps() < last) simulation.step();
  EXPECT_EQ(simulation.list_counts().sorts, of_the_cloud + 1);
}

/// Changes numbers of a part.
template <class Number, class Change>
void change(SimulationState& state, const char* part, const char* name, const Change& by) {
  auto numbers = column_of<Number>(state, part, name);
  by(numbers);
  put_column(state, part, name, std::move(numbers));
}

TEST(Resume, RefusesAStateOfAnotherBodyOrNone) {
  using enum Precision;
  const SimulationState good = bend("", binary64).begin().save();
  const auto refuse = [](const World& world, SimulationState state, const char* why) {
    Simulation simulation = world.begin();
    const auto before = state_hash(simulation.particles());
    test::expect_bad_input([&] { simulation.restore(state); }, {why});
    EXPECT_EQ(state_hash(simulation.particles()), before);
  };
  SimulationState from_file = good;
  from_file.body = 0;
  for (const World& other : {bend("", binary64, 17), tearing("", MaterialModel::bonded)}) {
    refuse(other, good, "its particles at rest");
    refuse(other, from_file, "particles, not");
  }
  refuse(bend("", binary32), good, "precision");
  refuse(with(bend("", binary64, 17), NeighborSearch::cells), bend("", binary32, 17).begin().save(),
         "single precision");
  SimulationState bad = good;
  bad.order[3] = bad.order[4];
  refuse(bend("", binary64), bad, "twice");
  const std::size_t end = std::get<MovingInDouble>(good.moving).v[1].size() - 1;
  for (const std::size_t lost : {std::size_t{0}, std::size_t{7}, end}) {
    bad = good;
    std::get<MovingInDouble>(bad.moving).v[1][lost] = NAN;
    refuse(bend("", binary64), bad, "finite");
  }
  bad = good;
  bad.steps = -1;
  refuse(bend("", binary64), bad, "steps");
  bad = good;
  auto ledgers = part_of<Ledgers>(good, ledgers_part);
  ledgers.of_world.work = NAN;
  put_part(bad, ledgers_part, ledgers);
  refuse(bend("", binary64), bad, "energies");
  bad = bend("", binary32).begin().save();
  bad.fixed_point_units.length = 0;
  refuse(bend("", binary32), bad, "units");
  const World tears = tearing("", MaterialModel::bonded);
  const SimulationState torn = tears.begin().save();
  bad = torn;
  change<std::uint32_t>(bad, "bonds", "lanes", [&](auto& numbers) { numbers.pop_back(); });
  refuse(tears, bad, "bonds");
  bad = torn;
  change<std::uint32_t>(bad, "bonds", "lanes",
                        [&](auto& numbers) { numbers.front() = ~numbers.front(); });
  refuse(tears, bad, "bonds");
  for (const double value : {double(NAN), HUGE_VAL}) {
    bad = torn;
    change<double>(bad, "bonds", "creep", [&](auto& numbers) { numbers[7] = value; });
    refuse(tears, bad, "length");
  }
  for (const double value : {double(NAN), HUGE_VAL}) {
    bad = torn;
    change<double>(bad, "branches", "stretches", [&](auto& numbers) { numbers[7] = value; });
    refuse(tears, bad, "branch");
    bad = torn;
    change<double>(bad, "branches", "clocks", [&](auto& numbers) { numbers[1] = value; });
    refuse(tears, bad, "branch");
  }
  bad = torn;
  change<double>(bad, "branches", "stretches", [&](auto& numbers) { numbers.pop_back(); });
  refuse(tears, bad, "branches");
  const World in_cells = with(tears, NeighborSearch::cells);
  bad = in_cells.begin().save();
  refuse(tears, bad, "cells");
  change<double>(bad, "bonds of cells", "rest", [&](auto& numbers) { numbers.pop_back(); });
  refuse(in_cells, bad, "bonds");
  bad = in_cells.begin().save();
  change<double>(bad, "branches", "stretches", [&](auto& numbers) { numbers.pop_back(); });
  refuse(in_cells, bad, "branches");
}

}  // namespace sinew::resume_test

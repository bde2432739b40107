// SPDX-License-Identifier: GPL-3.0-or-later
// A body in the grips of a testing machine.
#include <sinew/world/supports.h>

#include "support/all_steppers.h"
#include "support/expect_error.h"
#include "support/machine.h"

namespace sinew::supports_test {

using namespace machine;
using enum Precision;

constexpr std::array<bool, 3> all = {true, true, true};
constexpr std::array<bool, 3> along_x = {true, false, false};
constexpr std::array<bool, 3> along_z = {false, false, true};

/// A clamp below, and a grip above that pulls, twists or lets slide.
Machine gripped(const Vec3& velocity, const Vec3& spin = Vec3::Zero(),
                std::array<bool, 3> holds = all) {
  Machine machine;
  const Vec3 pivot(0, 0, machine.rest.back().z());
  machine.world.supports = {{"clamp", machine.bottom()},
                            {"grip", machine.top(), holds, moving(pivot, velocity, spin), pivot}};
  return machine;
}

TEST(Supports, HoldExactlyWhatTheyHoldAndNothingElse) {
  for (const Integrator integrator :
       {Integrator::symplectic_euler, Integrator::explicit_euler, Integrator::velocity_verlet}) {
    Machine machine = gripped({0.01, 0, 0.05}, {0, 0, 0.4}, {true, false, true});
    machine.settings.solver.integrator = integrator;
    machine.settings.solver.gravity = {0, 0.5, 0};
    const Simulation simulation = machine.after(0.05);
    const Particles& now = simulation.particles();
    for (const std::uint32_t i : machine.world.supports[0].particles)
      EXPECT_EQ(now.position(i), machine.rest[i]);
    const ObstaclePose grip = machine.world.supports[1].motion(simulation.time(), {});
    double free = 0;
    for (const std::uint32_t i : machine.world.supports[1].particles) {
      const Vec3 place =
          grip.frame.origin +
          grip.frame.rotation * (machine.rest[i] - Vec3(0, 0, 0) - machine.world.supports[1].pivot);
      EXPECT_NEAR(now.position(i).x(), place.x(), 1e-15);
      EXPECT_NEAR(now.position(i).z(), place.z(), 1e-15);
      free = std::max(free, std::abs(now.position(i).y() - place.y()));
    }
    EXPECT_GT(free, 1e-3 * r);
  }
}

/// A roller on a slope below, a clamp above.
Machine on_slope(const Vec3& along) {
  Machine machine = gripped({0, 0, 0});
  machine.world.supports[0].along = along;
  machine.world.supports[1].motion = {};
  machine.settings.solver.gravity = {0.5, 0.2, -1};
  return machine;
}

TEST(Supports, OfAnyDirectionLetSlideAcross) {
  const Vec3 along = Vec3(1, -2, 3).normalized();
  for (const bool cells : {false, true})
    for (const Precision precision : {binary64, binary32}) {
      if (cells && precision == binary32) continue;
      Machine machine = on_slope(along);
      machine.settings.solver.precision = precision;
      if (cells) machine.settings = test::with_cells(machine.settings);
      Simulation simulation = machine.after(0.05);
      double slid = 0;
      for (const std::uint32_t i : machine.bottom()) {
        const Vec3 moved = simulation.particles().position(i) - machine.rest[i];
        EXPECT_LT(std::abs(along.dot(moved)), (precision == binary64 ? 1e-15 : 1e-6 * r));
        slid = std::max(slid, moved.norm());
      }
      EXPECT_GT(slid, 1e-3 * r);
      const Vec3 force = simulation.support_reactions()[0].force;
      EXPECT_GT(force.norm(), 0);
      EXPECT_LT(force.cross(along).norm(), 1e-12 * force.norm());
    }
}

TEST(Supports, OfAnyDirectionBalance) {
  const Machine machine = on_slope(Vec3(1, 0, 1).normalized());
  Simulation simulation = machine.at_rest({1, 1, 1e-7});
  EXPECT_LT((sum_of(simulation.support_reactions()) + machine.weight()).norm(),
            1e-6 * machine.weight().norm());
}

TEST(Supports, OfAnyDirectionShareNoParticles) {
  Machine machine = on_slope(Vec3(1, 0, 1).normalized());
  machine.world.supports.push_back({"roller", machine.bottom(), along_x});
  test::expect_bad_input([&] { machine.begin(); }, {"'clamp' and 'roller'", "oblique", "disjoint"});
}

TEST(Supports, ReactionsBalanceLoadsAndWeightAtRest) {
  for (const Precision precision : {binary64, binary32}) {
    Machine machine = gripped({0, 0, 0});
    machine.world.supports.pop_back();
    machine.settings.solver.gravity = {0.3, 0, -1};
    machine.settings.solver.precision = precision;
    machine.world.drag.rate = 15;
    machine.world.loads = {machine.pull(machine.top(), {0.02, 0.01, 0.05})};
    Simulation simulation = machine.after(6);
    const Vec3 reaction = sum_of(simulation.support_reactions()),
               loads = sum_of(simulation.load_reactions());
    const double most = reaction.norm();
    EXPECT_LT((loads - Vec3(0.02, 0.01, 0.05)).norm(), 1e-12);
    EXPECT_LT((reaction + loads + machine.weight()).norm(),
              (precision == binary64 ? 1e-6 : 1e-3) * most);
  }
}

TEST(Supports, MomentsBalanceAtRestToo) {
  Machine machine = gripped({0, 0, 0});
  machine.world.supports.pop_back();
  machine.world.supports[0].pivot = {0.3, -0.2, 0.1};
  machine.world.drag.rate = 15;
  machine.world.loads = {machine.pull(machine.top(), {0.02, 0.01, 0.05})};
  Simulation simulation = machine.after(6);
  const Vec3 moment = moment_of(simulation.support_reactions(), {machine.world.supports[0].pivot});
  const Vec3 load = moment_of(simulation.load_reactions(), {machine.world.loads[0].pivot});
  EXPECT_GT(load.norm(), 1e-4);
  EXPECT_LT((moment + load).norm(), 1e-6 * load.norm());
}

TEST(Supports, ARollerHasNoReactionAlongItsFreeDirections) {
  Machine machine = gripped({0.1, 0.2, 0.05}, Vec3::Zero(), along_z);
  machine.settings.solver.gravity = {1, 2, 3};
  Simulation simulation = machine.after(0.05);
  const Reaction on = simulation.support_reactions()[1];
  EXPECT_EQ(on.force.x(), 0);
  EXPECT_EQ(on.force.y(), 0);
  EXPECT_GT(std::abs(on.force.z()), 1e-4);
}

/// Work that supports do is what the body stores and loses.
TEST(Supports, DoTheWorkThatTheBodyStoresAndLoses) {
  for (const NeighborSearch search : {NeighborSearch::lists, NeighborSearch::cells})
    for (const Integrator integrator :
         {Integrator::symplectic_euler, Integrator::velocity_verlet}) {
      Machine machine = gripped({0, 0, 0.05}, {0, 0, 2}, {true, true, false});
      machine.settings.solver.integrator = integrator;
      machine.settings.solver.neighbor_search = search;
      Simulation simulation = machine.begin();
      const Energies start = simulation.energies();
      while (simulation.time() < 0.2) simulation.step();
      const Energies end = simulation.energies();
      EXPECT_GT(end.work_of_world, 1e-5);
      EXPECT_NEAR(end.stored() - start.stored(), end.work() - (end.dissipation - start.dissipation),
                  0.005 * end.work_of_world);
    }
}

/// What the particles gain that no support holds is what loads, weight and supports give; damping
/// that acts pair by pair adds nothing.
TEST(Supports, MomentumIsWhatLoadsAndReactionsGive) {
  Machine machine = gripped({0, 0, 0.05});
  machine.settings.solver.gravity = {0.5, 0, -1};
  machine.world.loads = {machine.pull(machine.bottom(), {0, 0.02, 0}),
                         machine.pull({40, 41, 42}, {0.01, 0, 0})};
  Simulation simulation = machine.begin();
  const auto momentum = [&] {
    Vec3 sum = Vec3::Zero();
    const Particles& now = simulation.particles();
    std::vector<bool> held(now.size());
    for (const Pinned& pin : simulation.body().world->pins) held[pin.particle] = true;
    for (std::size_t i = 0; i < now.size(); ++i)
      if (!held[i]) sum += now.mass * now.velocity(i);
    return sum;
  };
  for (int step = 0; step < 200; ++step) {
    const Vec3 before = momentum(), given = sum_of(simulation.support_reactions()) +
                                            sum_of(simulation.load_reactions()) + machine.weight();
    const double dt = simulation.time();
    simulation.step();
    const Vec3 gained = momentum() - before;
    ASSERT_LT((gained - (simulation.time() - dt) * given).norm(), 1e-10 * (simulation.time() - dt));
  }
}

TEST(Supports, ThatMeetHoldTheComponentsOfBoth) {
  Machine machine;
  const auto side = ids_where(machine.rest, [](const Vec3& p) { return p.x() < -0.02; });
  machine.world.supports = {{"floor", machine.bottom(), along_z}, {"wall", side, along_x}};
  hold(machine.world, machine.rest.size());
  std::size_t both = 0;
  for (const Pinned& pin : machine.world.pins) {
    EXPECT_FALSE(pin.is_pin());
    EXPECT_FALSE(pin.holds(1));
    both += pin.holds(0) && pin.holds(2) ? 1 : 0;
  }
  EXPECT_GT(both, 0U);
  EXPECT_EQ(both + machine.world.pins.size(), machine.bottom().size() + side.size());
}

TEST(Supports, OneOfTwoThatHoldTheSameAnswersForIt) {
  Machine one, two;
  one.world.supports = {{"clamp", one.bottom()}};
  two.world.supports = {{"clamp", two.bottom()}, {"again", two.bottom()}};
  for (Machine* machine : {&one, &two}) machine->settings.solver.gravity = {0, 0, -1};
  Simulation a = one.after(0.05), b = two.after(0.05);
  EXPECT_EQ(a.support_reactions()[0].force, b.support_reactions()[0].force);
  EXPECT_EQ(b.support_reactions()[1].force, Vec3(0, 0, 0));
}

TEST(Supports, ContradictionsAreRefused) {
  const auto refuse = [](World world, const std::vector<const char*>& why) {
    try {
      hold(world, 10);
      FAIL() << why.front();
    } catch (const Error& error) {
      for (const char* part : why)
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  };
  const ObstacleMotion up = moving({0, 0, 0}, {0, 0, 1});
  World world;
  world.supports = {{"a", {1, 2, 3}}, {"b", {3, 4}, along_z, up}};
  refuse(world, {"supports 'a' and 'b' both hold z of 1 particles", "; make their regions"});
  world.supports[1].holds = along_x;
  world.supports[0].holds = along_z;
  hold(world, 10);
  EXPECT_EQ(world.pins.size(), 4U);
  world.pins = {{3}};
  refuse(world, {"support 'a' holds particle 3, which world.pins hold"});
  world.pins.clear();
  world.supports[1].particles.clear();
  refuse(world, {"support 'b' holds no particles"});
  world.supports[1].particles = {10};
  refuse(world, {"particle 10 of 10"});
  world.supports[1] = {"b", {4}, {false, false, false}};
  refuse(world, {"support 'b' holds no axis"});
}

}  // namespace sinew::supports_test

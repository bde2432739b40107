// SPDX-License-Identifier: GPL-3.0-or-later
// Damping relative to what holds a body: what it keeps, what it answers, and how a body rings that
// is held.
#include <sinew/world/references.h>

#include <Eigen/Geometry>

#include <sinew/analysis/elastic_modes.h>

#include "support/all_steppers.h"
#include "support/machine.h"

namespace sinew::rigid_damping_test {

using namespace machine;
using enum Precision;

/// A bar whose damping ratio is asked for.
Machine bar(int height = 25, double ratio = 0.2) {
  Machine machine(MaterialModel::bonded, height);
  machine.settings.material.damping_form = DampingForm::rigid;
  machine.settings.material.damping_ratio = ratio;
  return machine;
}

Particles moving_as(const Machine& machine, const Vec3& velocity, const Vec3& spin,
                    double shake = 0) {
  const Material material = test::material_of(machine.settings);
  Particles particles = test::shaken(machine.rest, material, shake * r, shake);
  Vec3 center = Vec3::Zero();
  for (const Vec3& p : machine.rest) center += p / static_cast<double>(machine.rest.size());
  for (std::size_t i = 0; i < particles.size(); ++i)
    particles.set_velocity(
        i, particles.velocity(i) + velocity + spin.cross(particles.position(i) - center));
  return particles;
}

struct Momenta {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
};

Momenta momenta_of(const Particles& particles) {
  Momenta sum;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    sum.linear += particles.mass * particles.velocity(i);
    sum.angular += particles.mass * particles.position(i).cross(particles.velocity(i));
  }
  return sum;
}

TEST(RigidDamping, OfAFreeBodyKeepsItsMomenta) {
  for (const bool cells : {false, true}) {
    Machine machine = bar(9);
    if (cells) machine.settings = test::with_cells(machine.settings);
    const Particles particles = moving_as(machine, {0.3, -0.1, 0.2}, {1, 2, -1}, 0.05);
    const Momenta before = momenta_of(particles);
    Simulation simulation = machine.begin(machine.body(), particles);
    ASSERT_GT(simulation.body().rigid_damping->rate, 0);
    for (int step = 0; step < 400; ++step) simulation.step();
    const Momenta after = momenta_of(simulation.particles());
    EXPECT_LT((after.linear - before.linear).norm(), 1e-12 * before.linear.norm());
    EXPECT_LT((after.angular - before.angular).norm(), 1e-11 * before.angular.norm());
  }
}

/// A thin one, of two layers, and one of a single row, which has no moment about itself.
TEST(RigidDamping, OfFlatAndThinBodiesKeepsTheirMomentaToo) {
  for (const Points& rest :
       {test::fcc_box(9, 9, 2, r), Points{{0, 0, 0}, {0, 0, 2 * r}, {0, 0, 4 * r}}}) {
    Machine machine = bar();
    machine.rest = rest;
    machine.settings.material.damping_ratio = {};
    Body body = machine.body();
    body.rigid_damping = std::make_shared<const RigidDamping>(rigid_damping_of(body, 20));
    const Particles particles = moving_as(machine, {0.3, -0.1, 0.2}, {0.1, 0.2, 0}, 1e-3);
    const Momenta before = momenta_of(particles);
    Simulation simulation = machine.begin(body, particles);
    for (int step = 0; step < 200; ++step) simulation.step();
    const Momenta after = momenta_of(simulation.particles());
    EXPECT_LT((after.linear - before.linear).norm(), 1e-12 * before.linear.norm());
    EXPECT_LT((after.angular - before.angular).norm(), 1e-10 * before.angular.norm());
  }
}

/// Parts each move by themselves: one at rest does not brake the other.
TEST(RigidDamping, OfTwoBodiesIsOfEachAlone) {
  Machine machine = bar(9);
  const std::size_t each = machine.rest.size();
  for (std::size_t i = 0; i < each; ++i) machine.rest.push_back(machine.rest[i] + Vec3(0.5, 0, 0));
  Particles particles = moving_as(machine, Vec3::Zero(), Vec3::Zero());
  for (std::size_t i = 0; i < each; ++i) particles.set_velocity(i, {0, 0.1, 0});
  Simulation simulation = machine.begin(machine.body(), particles);
  for (int step = 0; step < 400; ++step) simulation.step();
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const auto id = static_cast<std::size_t>(simulation.particles().id[i]);
    EXPECT_LT((simulation.particles().velocity(i) - particles.velocity(id)).norm(), 1e-12);
  }
}

TEST(RigidDamping, LeavesRigidMotionsAloneThatNothingHolds) {
  struct Held {
    const char* what;
    std::array<bool, 3> holds;
    Vec3 velocity, spin;
  };
  for (const Held& held : {Held{"roller", {false, false, true}, {0.1, -0.2, 0}, {0, 0, 1}},
                           Held{"slide", {true, false, true}, {0, 0.1, 0}, {0, 0, 0}}}) {
    Machine machine = bar(9);
    machine.world.supports = {{held.what, machine.bottom(), held.holds}};
    const Particles particles = moving_as(machine, held.velocity, held.spin);
    Simulation simulation = machine.begin(machine.body(), particles);
    const double before = simulation.energies().kinetic;
    for (int step = 0; step < 300; ++step) simulation.step();
    EXPECT_NEAR(simulation.energies().kinetic, before, 1e-3 * before) << held.what;
  }
}

/// A pendulum on one held particle falls and swings undamped, but for what its flesh does.
TEST(RigidDamping, LetsABodySwingAboutAPoint) {
  Machine machine = bar(13, 0.5);
  machine.settings.material.young_modulus = 1e6;
  machine.settings.solver.gravity = {3, 0, -3};
  machine.world.pins = {{ids_where(
      machine.rest, [](const Vec3& p) { return p.z() < r && std::hypot(p.x(), p.y()) < r; })[0]}};
  Simulation simulation = machine.begin();
  const Energies start = simulation.energies();
  double most = 0;
  while (simulation.time() < 0.8) {
    simulation.step();
    most = std::max(most, simulation.energies().kinetic);
  }
  EXPECT_LT(simulation.energies().dissipation - start.dissipation, 0.05 * most);
  EXPECT_GT(most, 0);
}

/// alpha / 2 w + beta w / 2, of free bodies and of held ones.
TEST(RigidDamping, IsRayleighsWhereItsConstantsAreGiven) {
  for (const bool free : {true, false})
    for (const auto& [alpha, beta] : {std::pair{3.0, 0.0}, {0.0, 2e-3}, {2.0, 1e-3}}) {
      Machine machine = bar();
      machine.settings.material.damping_ratio = {};
      machine.settings.material.rayleigh = {{alpha, beta}};
      if (!free) machine.world.supports = {{"bottom", machine.bottom()}};
      const Body body = machine.body();
      const ElasticModes modes = elastic_modes(body);
      const double w = modes.frequency(), asked = alpha / (2 * w) + beta * w / 2;
      const double rate = body.rigid_damping ? body.rigid_damping->rate : 0;
      EXPECT_EQ(rate, alpha);
      EXPECT_NEAR(modes.damping_ratio(body.material.damping, rate), asked, 0.02 * asked);
    }
}

/// The momentum that damping takes, supports give.
TEST(RigidDamping, IsAnsweredByWhatItIsRelativeTo) {
  for (const Precision precision : {binary64, binary32}) {
    Machine machine = bar(13);
    machine.settings.solver.precision = precision;
    machine.world.supports = {{"clamp", machine.bottom()},
                              {"grip",
                               machine.top(),
                               {true, true, true},
                               moving({0, 0, machine.rest.back().z()}, {0.02, 0, 0.05}),
                               {0, 0, machine.rest.back().z()}}};
    Simulation simulation = machine.after(0.15);
    const Particles before = simulation.particles();
    const Vec3 force = sum_of(simulation.support_reactions());
    const double step = simulation.stepping().step;
    simulation.step();
    Vec3 gained = Vec3::Zero();
    for (std::size_t i = 0; i < before.size(); ++i)
      gained += before.mass * (simulation.particles().velocity(i) - before.velocity(i)) / step;
    EXPECT_LT((force - gained).norm(), (precision == binary64 ? 1e-9 : 1e-3) * force.norm());
  }
}

/// What supports and bones put in is stored or lost.
TEST(RigidDamping, IsInTheBalanceOfEnergy) {
  for (const bool cells : {false, true})
    for (const Precision precision : {binary64, binary32}) {
      if (cells && precision == binary32) continue;
      Machine machine = bar(13);
      machine.settings.solver.precision = precision;
      if (cells) machine.settings = test::with_cells(machine.settings);
      const Vec3 pivot(0, 0, machine.rest.back().z());
      machine.world.supports = {{"clamp", machine.bottom()},
                                {"grip",
                                 machine.top(),
                                 {true, true, true},
                                 moving(pivot, {0.02, 0, 0.05}, {0, 0, 0.5}),
                                 pivot}};
      Simulation simulation = machine.begin();
      const double before = simulation.energies().stored();
      while (simulation.time() < 0.3) simulation.step();
      const Energies end = simulation.energies();
      EXPECT_NEAR(end.stored() - before - end.work_of_world - end.work_of_bones + end.dissipation,
                  0, 0.01 * std::abs(end.work_of_world))
          << cells << static_cast<int>(precision);
      EXPECT_GT(end.dissipation, 0);
    }
}

TEST(RigidDamping, IsThatOfTheCellsInListsOfAllInstructions) {
  Machine machine = bar(9);
  const Vec3 pivot(0, 0, machine.rest.back().z());
  machine.world.supports = {
      {"clamp", machine.bottom()},
      {"grip", machine.top(), {true, false, true}, moving(pivot, {0.02, 0, 0.05}), pivot}};
  Simulation lists = machine.after(0.1);
  machine.settings = test::with_cells(machine.settings);
  const Simulation cells = machine.after(0.1);
  EXPECT_LT(test::largest_distance(lists.particles(), cells.particles()), 1e-9 * r);
}

TEST(RigidDamping, IsTheSameAfterASave) {
  for (const Precision precision : {binary64, binary32}) {
    Machine machine = bar(9);
    machine.settings.solver.precision = precision;
    const Particles particles = moving_as(machine, {0.3, -0.1, 0.2}, {1, 2, -1}, 0.02);
    Simulation whole = machine.begin(machine.body(), particles),
               first = machine.begin(machine.body(), particles);
    for (int step = 0; step < 150; ++step) whole.step(), first.step();
    Simulation second = machine.begin(machine.body(), particles);
    second.restore(first.save());
    for (int step = 0; step < 150; ++step) whole.step(), second.step();
    EXPECT_EQ(test::largest_distance(whole.particles(), second.particles()), 0);
  }
}

/// A clamped bar rings at the frequency and with the ratio that are told; so does one held at both
/// ends.
TEST(HeldBars, RingAsTheirModesSay) {
  for (const bool both : {false, true})
    for (const double ratio : {0.05, 0.1}) {
      Machine machine = bar(31, ratio);
      machine.world.supports = {{"bottom", machine.bottom()}};
      if (both) machine.world.supports.push_back({"top", machine.top()});
      const Body body = machine.body();
      const ElasticModes modes = elastic_modes(body);
      const double height = machine.rest.back().z(), period = 2 * pi / modes.frequency();
      Particles particles = particles_at(machine.rest, r, body.material.mass);
      for (std::size_t i = 0; i < particles.size(); ++i) {
        const double s = machine.rest[i].z() / height;
        const double shape = both ? std::pow(std::sin(pi * s), 2) : s * s * (3 - s) / 2;
        particles.set_velocity(i, {0.05 * r * modes.frequency() * shape, 0, 0});
      }
      Simulation simulation = machine.begin(body, particles);
      const auto swing = [&] {
        double sum = 0;
        for (std::size_t i = 0; i < particles.size(); ++i)
          sum += particles.velocity(i).x() *
                 (simulation.particles().position(i).x() - machine.rest[i].x());
        return sum;
      };
      std::vector<double> peaks, times;
      double before = 0, last = 0;
      while (simulation.time() < 3.2 * period) {
        simulation.step();
        const double now = swing();
        if ((last - before) * (now - last) < 0) {
          peaks.push_back(std::abs(last));
          times.push_back(simulation.time());
        }
        before = last;
        last = now;
      }
      ASSERT_GE(peaks.size(), 5u);
      const double decay = std::log(peaks[0] / peaks[4]) / 4;
      EXPECT_NEAR(decay / std::hypot(pi, decay), ratio, 0.1 * ratio) << both;
      EXPECT_NEAR((times[4] - times[0]) / 2, period, 0.03 * period) << both;
    }
}

/// Above what holds it, a bar that is pulled moves in proportion: nothing else drags it.
TEST(RigidDamping, OfABarThatIsPulledIsRelativeToBothEnds) {
  Machine machine = bar(25, 0.5);
  const Vec3 pivot(0, 0, machine.rest.back().z());
  machine.world.supports = {
      {"clamp", machine.bottom()},
      {"grip", machine.top(), {true, true, true}, moving(pivot, {0, 0, 0.05}), pivot}};
  const Body body = machine.body();
  const RigidDamping& damping = *body.rigid_damping;
  const auto motions = motions_of_holders(damping, body, 0, {});
  for (std::size_t i = 0; i < machine.rest.size(); ++i) {
    const Vec3 v = damping.velocity_at(i, machine.rest[i], motions);
    EXPECT_NEAR(
        v.z(),
        0.05 * (machine.rest[i].z() - machine.rest[0].z()) / (pivot.z() - machine.rest[0].z()),
        0.03 * 0.05);
  }
}

/// What breaks off falls as it would fall.
TEST(RigidDamping, OfAPieceThatBreaksOffIsItsOwn) {
  for (const bool cells : {false, true}) {
    Machine machine = bar(9, 0.1);
    machine.settings.material.young_modulus = 1e5;
    machine.settings.material.breaking_strain = 0.01;
    if (cells) machine.settings = test::with_cells(machine.settings);
    machine.world.supports = {{"clamp", machine.bottom()}};
    Particles particles = moving_as(machine, Vec3::Zero(), Vec3::Zero());
    const double middle = machine.rest.back().z() / 2;
    for (std::size_t i = 0; i < particles.size(); ++i)
      if (machine.rest[i].z() > middle) particles.set_velocity(i, {0, 0, 1});
    Simulation simulation = machine.begin(machine.body(), particles);
    const auto speed = [&] {
      Vec3 sum = Vec3::Zero();
      int count = 0;
      for (std::size_t i = 0; i < particles.size(); ++i)
        if (machine.rest[i].z() > middle) sum += simulation.particles().velocity(i), ++count;
      return sum.z() / count;
    };
    for (int step = 0; step < 512; ++step) simulation.step();
    const double parted = speed();
    ASSERT_GT(parted, 0.1);
    Simulation resumed = machine.begin(machine.body(), particles);
    resumed.restore(simulation.save());
    for (int step = 0; step < 1000; ++step) simulation.step(), resumed.step();
    EXPECT_NEAR(speed(), parted, 1e-6 * parted) << cells;
    EXPECT_EQ(test::largest_distance(simulation.particles(), resumed.particles()), 0);
  }
}

}  // namespace sinew::rigid_damping_test

// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/stepping/simulation.h>

#include <gtest/gtest.h>
#include <algorithm>
#include <numeric>

#include <sinew/core/parallel.h>
#include <sinew/scene/prepare.h>
#include <sinew/scene/rig.h>

#include "support/expect_error.h"
#include "support/world.h"

namespace sinew::simulation_test {

constexpr double r = 0.01;
constexpr Integrator integrators[] = {Integrator::symplectic_euler, Integrator::explicit_euler,
                                      Integrator::velocity_verlet};

Points bar() { return test::fcc_box(11, 11, 25, r); }

Settings bend_scene() {
  Settings settings = test::box_scene(25);
  settings.tracks = {test::track("upper", {test::bend_key(0, 0), test::bend_key(0.3, 40)})};
  return settings;
}

TEST(Simulation, StretchingBonesTakeTheBodyAlong) {
  Settings settings = test::box_scene(25);
  KeyDefinition rest, longer;
  rest.time = 0;
  longer.time = 0.2;
  longer.stretch = 1.1;
  settings.tracks = {test::track("lower", {rest, longer}), test::track("upper", {rest, rest})};
  settings.tracks[1].keys.pop_back();
  const Points points = test::fcc_box(7, 7, 25, 0.01);
  Simulation simulation = test::make_simulation(settings, points);
  while (simulation.time() < 0.6) simulation.step();
  const Bone& lower = simulation.body().skeleton.bones[0];
  const Particles& now = simulation.particles();
  double shift = 0;
  int above = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i].z() > 1.5 * lower.length) shift += now.position(i).z() - points[i].z(), ++above;
  EXPECT_NEAR(shift / above, 0.1 * lower.length, 0.02 * lower.length);
}

TEST(FreeFall, HasTheClosedFormOfEachIntegrator) {
  const double dt = 1e-3;
  const Vec3 g(1, 2, -9.81);
  const int n = 100;
  for (const Integrator integrator : integrators) {
    Settings settings = test::unbound(test::box_scene(25));
    settings.solver.integrator = integrator;
    settings.solver.gravity = g;
    const Points rest = test::fcc_box(5, 5, 5, r);
    Simulation simulation = test::simulation_from(settings, rest, particles_at(rest, r, 1), dt);
    for (int step = 0; step < n; ++step) simulation.step();
    // Sums of dt v: the velocity after, before, or in the middle of each step.
    const double steps = integrator == Integrator::symplectic_euler ? n * (n + 1.0)
                         : integrator == Integrator::explicit_euler ? n * (n - 1.0)
                                                                    : 1.0 * n * n;
    for (std::size_t i = 0; i < rest.size(); ++i) {
      const Vec3 fallen = simulation.particles().position(i) - rest[i];
      ASSERT_LT((fallen - dt * dt / 2 * steps * g).norm(), 1e-12);
      ASSERT_LT((simulation.particles().velocity(i) - n * dt * g).norm(), 1e-10);
    }
    EXPECT_DOUBLE_EQ(simulation.time(), n * dt);
    EXPECT_EQ(simulation.steps(), n);
  }
}

TEST(Rest, StaysRestForBothPackings) {
  for (const Points& points : {bar(), test::hcp_ball(9, r)}) {
    Simulation simulation = test::make_simulation(test::box_scene(25), points);
    for (int step = 0; step < 500; ++step) simulation.step();
    EXPECT_LT(test::largest_speed(simulation.particles()), 1e-13);
  }
}

TEST(ThreadCounts, GiveTheSameBitsAfterABend) {
  for (const auto& [integrator, form] :
       {std::pair(Integrator::symplectic_euler, DampingForm::paper),
        {Integrator::velocity_verlet, DampingForm::central}}) {
    Settings settings = bend_scene();
    settings.solver.integrator = integrator;
    settings.material.damping_form = form;
    std::vector<std::uint64_t> hashes;
    std::vector<double> ledger;
    for (const int threads : {1, 2, 3, 8})
      with_threads(threads, [&] {
        Simulation simulation = test::make_simulation(settings, bar());
        while (simulation.time() < 0.2) simulation.step();
        hashes.push_back(state_hash(simulation.particles()));
        const Energies energies = simulation.energies();
        ledger.push_back(energies.stored() + energies.work_of_bones + energies.dissipation);
      });
    EXPECT_EQ(hashes, std::vector<std::uint64_t>(4, hashes[0]));
    EXPECT_EQ(ledger, std::vector<double>(4, ledger[0]));
  }
}

TEST(OrderOfParticles, ChangesTheStateByRoundingOnly) {
  const Settings settings = bend_scene();
  const Points rest = bar();
  std::vector<std::size_t> order(rest.size());
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(5));
  const Particles sorted = particles_at(rest, r, test::material_of(settings).mass);
  Simulation one = test::simulation_from(settings, rest, sorted, 1e-3);
  Simulation other = test::simulation_from(settings, rest, test::reordered(sorted, order), 1e-3);
  for (int step = 0; step < 150; ++step) one.step(), other.step();
  EXPECT_GT((one.particles().position(rest.size() - 1) - rest.back()).norm(), r);
  for (std::size_t i = 0; i < rest.size(); ++i) {
    ASSERT_EQ(other.particles().id[i], static_cast<std::int32_t>(order[i]));
    ASSERT_LT((one.particles().position(order[i]) - other.particles().position(i)).norm(),
              1e-9 * r);
  }
}

TEST(Unstable, StopsNamingStepTimeParticleBoneAndCure) {
  const Settings settings = bend_scene();
  const Points rest = bar();
  const Body body = test::make_body(settings, rest);
  const double limit = step_limit(Integrator::symplectic_euler, body.material, body.springs);
  Simulation simulation = test::simulation_from(
      settings, rest, test::shaken(rest, body.material, 0, 1e-6), 1.2 * limit);
  test::expect_error(Exit::unstable,
                     [&] {
                       for (int step = 0; step < 1000; ++step) simulation.step();
                     },
                     {"step ", " s: particle ", "bone '", "relative to its bone in one step", "; ",
                      "solver.time_step"});
}

TEST(Unstable, NamesTheParticleByItsId) {
  Points rest = test::fcc_box(5, 5, 5, r);
  const Settings settings = test::box_scene(25);
  Particles particles = particles_at(rest, r, 1);
  std::reverse(particles.id.begin(), particles.id.end());
  std::reverse(rest.begin(), rest.end());
  particles.set_velocity(3, {1000, 0, 0});
  Simulation fast = test::simulation_from(settings, rest, particles, 1e-3);
  const std::string id = std::to_string(rest.size() - 4);
  test::expect_error(Exit::unstable, [&] { fast.step(); },
                     {"step 0 at 0 s: particle " + id + " on bone 'lower'", "0.25 r"});
  particles.set_velocity(3, {std::nan(""), 0, 0});
  Settings undamped = settings;  // so that no neighbor is pulled along in the same step
  undamped.material.damping = 0;
  Simulation broken = test::simulation_from(undamped, rest, particles, 1e-3);
  test::expect_error(Exit::unstable, [&] { broken.step(); }, {"particle " + id, "not finite"});
}

TEST(Unstable, StaysWhereItWasAndNamesTheParticlesThatFailed) {
  const Points rest = bar();
  for (const auto search : {NeighborSearch::lists, NeighborSearch::cells})
    for (const auto precision : {Precision::binary64, Precision::binary32}) {
      Settings settings = test::box_scene(25);
      settings.solver.neighbor_search = search;
      settings.solver.precision = precision;
      settings.material.damping = 0;
      Particles particles = particles_at(rest, r, 1);
      particles.set_velocity(9, {0, 1000, 0});
      particles.set_velocity(4, {std::nan(""), 0, 0});
      Simulation simulation = test::simulation_from(settings, rest, particles, 1e-3);
      test::expect_error(Exit::unstable, [&] { simulation.step(); }, {"particle 4 "});
      EXPECT_EQ(simulation.steps(), 0);
      ASSERT_EQ(simulation.offenders().size(), 2u);
      const Offender &lost = simulation.offenders()[0], &fast = simulation.offenders()[1];
      EXPECT_EQ(lost.particle, 4u);
      EXPECT_FALSE(lost.finite);
      EXPECT_EQ(lost.moved, 0);
      EXPECT_EQ(fast.particle, 9u);
      EXPECT_TRUE(fast.finite);
      EXPECT_NEAR(fast.moved, 1, 1e-3);  // its bone holds it back
      for (std::size_t i = 0; i < rest.size(); ++i)
        EXPECT_LT((simulation.particles().position(i) - rest[i]).norm(), 1e-6 * r);
    }
}

TEST(Unstable, NamesTheFastestOfManyForEveryThreadCount) {
  const Settings settings = test::box_scene(25);
  const Points rest = bar();
  Particles particles = particles_at(rest, r, 1);
  for (std::size_t i = 700; i < rest.size(); ++i) particles.set_velocity(i, {1000, 0, 0});
  particles.set_velocity(901, {2000, 0, 0});
  for (const int threads : {1, 2, 3, 8})
    with_threads(threads, [&] {
      Simulation fast = test::simulation_from(settings, rest, particles, 1e-3);
      test::expect_error(Exit::unstable, [&] { fast.step(); }, {"particle 901 "});
    });
}

TEST(Unstable, DoesNotMindTheWholeBodyMovingFastWithItsBone) {
  Settings settings = test::box_scene(25);
  KeyDefinition end = test::bend_key(1, 0);
  end.translation = {30, 0, 0};  // 3 r in each step
  settings.tracks = {test::track("lower", {test::bend_key(0, 0), end})};
  settings.tracks[0].interpolation = Interpolation::linear;
  const Points rest = test::fcc_box(5, 5, 25, r);
  Particles particles = particles_at(rest, r, test::material_of(settings).mass);
  for (std::size_t i = 0; i < rest.size(); ++i) particles.set_velocity(i, {30, 0, 0});
  Simulation simulation = test::simulation_from(settings, rest, particles, 1e-3);
  EXPECT_NO_THROW({
    while (simulation.steps() < 200) simulation.step();
  });
}

// Half of the body has no bone: its change of motion counts, not its motion.
Body half_bound(const Settings& settings, const Points& rest) {
  Body body = test::make_body(settings, rest);
  BindOptions options;
  options.radius = r;
  options.core_radius = 2 * r;
  body.binding = bind_to_bones(rest, body.skeleton, options);
  EXPECT_TRUE(std::any_of(rest.begin(), rest.end(), [&, i = std::size_t(0)](const Vec3&) mutable {
    return body.binding.bone(i++) == no_bone;
  }));
  return body;
}

TEST(Unstable, DoesNotMindFleshWithoutABoneMovingFast) {
  Settings settings = test::box_scene(25);
  KeyDefinition end = test::bend_key(1, 0);
  end.translation = {30, 0, 0};  // 3 r in each step
  settings.tracks = {test::track("lower", {test::bend_key(0, 0), end})};
  settings.tracks[0].interpolation = Interpolation::linear;
  const Points rest = test::fcc_box(5, 5, 25, r);
  const Body body = half_bound(settings, rest);
  Particles particles = particles_at(rest, r, body.material.mass);
  for (std::size_t i = 0; i < rest.size(); ++i) particles.set_velocity(i, {30, 0, 0});
  for (const NeighborSearch search : {NeighborSearch::lists, NeighborSearch::cells}) {
    settings.solver.neighbor_search = search;
    Simulation simulation(body, motion_of(settings, body.skeleton), particles,
                          stepping_of(settings.solver, 1e-3));
    EXPECT_NO_THROW({
      while (simulation.steps() < 200) simulation.step();
    });
  }
}

TEST(Unstable, StopsWhereNoBoneHoldsTheFlesh) {
  for (const Integrator integrator : {Integrator::symplectic_euler, Integrator::velocity_verlet})
    for (const NeighborSearch search : {NeighborSearch::lists, NeighborSearch::cells}) {
      Settings settings = test::box_scene(25);
      settings.solver.integrator = integrator;
      settings.solver.neighbor_search = search;
      const Points rest = test::fcc_box(9, 9, 25, r);
      Body body = half_bound(settings, rest);
      body.springs.assign(body.springs.size(), {});
      const double step = 1.2 * step_limit(integrator, body.material, body.springs);
      Simulation simulation(body, motion_of(settings, body.skeleton),
                            test::shaken(rest, body.material, 0, 1e-6),
                            stepping_of(settings.solver, step));
      test::expect_error(Exit::unstable,
                         [&] {
                           for (int n = 0; n < 2000; ++n) simulation.step();
                         },
                         {"in one step: ", "; use solver.time_step"});
    }
}

TEST(OpenLoop, SpinsTheBodyThatTheServoHolds) {
  const auto spin = [](TwistForm form) {
    Settings settings = test::box_scene(25);
    settings.binding.twist_form = form;
    settings.tracks = {test::track("lower", {test::twist_key(0, 0), test::twist_key(0.2, 30)})};
    Simulation simulation = test::make_simulation(settings, test::fcc_box(7, 7, 25, r));
    while (simulation.time() < 0.6) simulation.step();
    double sum = 0;
    const Particles& now = simulation.particles();
    for (std::size_t i = 0; i < now.size(); ++i) sum += now.position(i).cross(now.velocity(i)).z();
    return sum / static_cast<double>(now.size());
  };
  EXPECT_GT(spin(TwistForm::open_loop), 10 * std::abs(spin(TwistForm::servo)));
}

TEST(Forces, AreThoseOfThePresentMomentAndSumToTheAcceleration) {
  Simulation simulation = test::make_simulation(bend_scene(), bar());
  for (int step = 0; step < 40; ++step) simulation.step();
  const Forces forces = simulation.forces();
  const Particles before = simulation.particles();
  const double time = simulation.time();
  simulation.step();
  const double dt = simulation.time() - time;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Vec3 gained = simulation.particles().velocity(i) - before.velocity(i);
    ASSERT_LT((gained - dt / before.mass * forces.total(i)).norm(), 1e-14);
    ASSERT_EQ(forces.total(i), forces.pair[i] + forces.damping[i] + forces.bone[i]);
  }
}

TEST(Simulation, GoesOnAsBeforeWhereItsResultsAreTakenAndTheirMemoryIsGivenBack) {
  for (const Precision precision : {Precision::binary64, Precision::binary32}) {
    Settings settings = bend_scene();
    settings.solver.precision = precision;
    Simulation kept = test::make_simulation(settings, bar());
    Simulation taken = test::make_simulation(settings, bar());
    Particles particles;
    Forces forces;
    for (int round = 0; round < 3; ++round) {
      for (int step = 0; step < 20; ++step) kept.step(), taken.step();
      taken.reuse(std::move(particles), std::move(forces));
      const double energy = taken.energies().kinetic;
      forces = taken.take_forces();
      particles = taken.take_particles();
      EXPECT_EQ(energy, kept.energies().kinetic);
      EXPECT_EQ(forces.pair, kept.forces().pair);
      EXPECT_EQ(forces.bone, kept.forces().bone);
      EXPECT_EQ(particles.id, kept.particles().id);
      EXPECT_EQ(state_hash(particles), state_hash(kept.particles()));
      EXPECT_EQ(taken.forces().damping, kept.forces().damping);  // found anew
      EXPECT_EQ(state_hash(taken.particles()), state_hash(kept.particles()));
    }
  }
}

}  // namespace sinew::simulation_test

// SPDX-License-Identifier: GPL-3.0-or-later
// Whole steps with lists and with cells: the same positions, velocities, forces and ledger to
// rounding, and the same message when a run fails.
#include <sinew/core/error.h>

#include "support/both_steppers.h"
#include "support/expect_error.h"

namespace sinew::steppers_test {

using namespace both_steppers;

TEST(Steppers, TakeTheSameStepsWithEveryIntegrator) {
  for (const Integrator integrator : integrators) {
    Settings settings = moving_scene();
    settings.solver.integrator = integrator;
    expect_same_steps(settings);
  }
}

TEST(Steppers, TakeTheSameStepsForEveryShapeOfThePairForce) {
  for (const double a : {2.0, 2.2})
    for (const double b : {2.6, 2 * std::sqrt(2.0), 3.2}) {
      SCOPED_TRACE(b);
      Settings settings = moving_scene();
      settings.material.a = a;
      settings.material.b = b;
      // Beyond 2 sqrt(2) r second neighbors attract, and the body implodes.
      expect_same_steps(settings, 0.02 * r, 0.05, 0.2, b > 2.9 ? 25 : 100);
    }
}

TEST(Steppers, TakeTheSameStepsForEveryStiffnessInTension) {
  for (const double lambda : {0.0, 0.1, 4.0}) {
    Settings settings = moving_scene();
    settings.material.lambda = lambda;
    expect_same_steps(settings);
  }
}

TEST(Steppers, TakeTheSameStepsWithGravityUndampedAndUnbound) {
  for (const Integrator integrator : integrators) {
    Settings heavy = moving_scene();
    heavy.solver.integrator = integrator;
    heavy.solver.gravity = {1, -2, -9.81};
    expect_same_steps(heavy);
    Settings undamped = moving_scene();
    undamped.solver.integrator = integrator;
    undamped.material.damping = 0;
    undamped.binding.bone_damping = 0;
    expect_same_steps(undamped, 0.02 * r, 0.02);
    Settings free = test::unbound(moving_scene());
    free.solver.integrator = integrator;
    expect_same_steps(free);
  }
}

TEST(Steppers, TakeTheSameStepsOfADisorderedBody) {
  const Settings settings = moving_scene();
  const Points rest = test::fcc_box(7, 7, 25, r);
  const Body body = test::make_body(settings, rest);
  Both both(settings, rest, test::shaken(rest, body.material, 0.8 * r, 0.1),
            test::step_of(settings, body, 0.2));
  for (const int steps : {1, 10}) {
    both.step_until(steps);
    expect_same(both, 1e-12);
  }
}

TEST(Steppers, TakeTheSameStepsInAnyOrderOfTheParticles) {
  const Settings settings = moving_scene();
  const Points rest = test::fcc_box(7, 7, 25, r);
  const Body body = test::make_body(settings, rest);
  std::vector<std::size_t> order(rest.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i * 11 % order.size();
  ASSERT_NE(order.size() % 11, 0u);
  const Particles shaken = test::shaken(rest, body.material, 0.02 * r, 0.05);
  Both both(settings, rest, test::reordered(shaken, order), test::step_of(settings, body));
  both.step_until(50);
  expect_same(both, 1e-12);
  EXPECT_EQ(both.lists.particles().id, both.cells.particles().id);
}

TEST(Steppers, TakeTheSameStepsOfAFewParticles) {
  const Points box = test::fcc_box(5, 5, 25, r);
  for (const std::size_t size : {1, 2, 3, 8, 9, 17, 33}) {
    SCOPED_TRACE(size);
    const Points rest(box.begin(), box.begin() + static_cast<std::ptrdiff_t>(size));
    const Settings settings = moving_scene();
    const Body body = test::make_body(settings, rest);
    Both both(settings, rest, test::shaken(rest, body.material, 0.05 * r, 0.02),
              test::step_of(settings, body, 0.2));
    both.step_until(60);
    expect_same(both, 1e-12);
  }
}

TEST(Steppers, KeepTheirLedgersAlikeOverAWholeBend) {
  Settings settings = moving_scene();
  settings.solver.gravity = {0, 0, -1};
  const Points rest = test::fcc_box(7, 7, 25, r);
  const Body body = test::make_body(settings, rest);
  Both both(settings, rest, particles_at(rest, r, body.material.mass),
            test::step_of(settings, body));
  both.step_until(200);
  expect_same_energies(both.lists.energies(), both.cells.energies(), 1e-6);
}

/// Every fourth particle where the one before is.
Particles doubled(const Points& rest, const Material& material) {
  Particles particles = particles_at(rest, r, material.mass);
  for (std::size_t i = 1; i < rest.size(); i += 4)
    particles.set_position(i, particles.position(i - 1));
  return particles;
}

TEST(Coincident, ParticlesSeparateAlikeWithListsAndCells) {
  const Points rest = test::fcc_box(5, 5, 9, r);
  const Settings settings = test::box_scene(9);
  const Body body = test::make_body(settings, rest);
  const Particles start = doubled(rest, body.material);
  std::vector<std::size_t> backwards(rest.size());
  for (std::size_t i = 0; i < rest.size(); ++i) backwards[i] = rest.size() - 1 - i;
  for (const Particles& particles : {start, test::reordered(start, backwards)}) {
    Both both(settings, rest, particles, test::step_of(settings, body, 0.1));
    expect_same(both, 1e-12);
    both.step_until(10);
    expect_same(both, 1e-12);
  }
}

TEST(Coincident, ParticlesSeparateAlikeInSinglePrecision) {
  const Points rest = test::fcc_box(5, 5, 9, r);
  const Settings settings = test::box_scene(9);
  const Body body = test::make_body(settings, rest);
  const double step = test::step_of(settings, body, 0.1);
  const Particles start = doubled(rest, body.material);
  Simulation floats =
      test::simulation_from(test::in(Precision::binary32, settings), rest, start, step);
  Simulation cells = test::simulation_from(test::with_cells(settings), rest, start, step);
  while (cells.steps() < 10) floats.step(), cells.step();
  EXPECT_LT(test::largest_distance(floats.particles(), cells.particles()), 1e-4 * r);
}

TEST(Coincident, PairLeavesAlongXTheLowerIdToTheLeft) {
  const Settings settings = test::unbound(test::box_scene(9));
  const Points rest{{0, 0, 0.1}, {0, 0, 0.1}};
  for (const Precision precision : test::precisions)
    for (const bool swapped : {false, true}) {
      Particles particles = particles_at(rest, r, test::material_of(settings).mass);
      if (swapped) std::swap(particles.id[0], particles.id[1]);
      Simulation simulation =
          test::simulation_from(test::in(precision, settings), rest, particles, 1e-4);
      simulation.step();
      const Particles& now = simulation.particles();
      const int lower = swapped ? 1 : 0;
      EXPECT_LT(now.u[lower], 0);
      EXPECT_EQ(now.u[lower], -now.u[1 - lower]);
      EXPECT_EQ(now.v[0], 0);
      EXPECT_EQ(now.w[0], 0);
    }
}

/// The message of a run that fails; empty when it does not within `steps`.
std::string last_words(const Settings& settings, const Points& rest, const Particles& particles,
                       double step, int steps) {
  try {
    Simulation simulation = test::simulation_from(settings, rest, particles, step);
    while (simulation.steps() < steps) simulation.step();
  } catch (const Error& error) {
    EXPECT_EQ(error.exit(), Exit::unstable);
    return error.what();
  }
  return "";
}

void expect_same_last_words(Settings settings, const Points& rest, const Particles& particles,
                            double step, int steps = 1) {
  const std::string expected = last_words(test::with_cells(settings), rest, particles, step, steps);
  EXPECT_NE(expected, "");
  for (const Precision precision : test::precisions)
    EXPECT_EQ(last_words(test::in(precision, settings), rest, particles, step, steps), expected);
}

TEST(Failures, NameTheSameParticleThatIsTooFast) {
  const Points rest = test::fcc_box(5, 5, 25, r);
  const Settings settings = test::box_scene(25);
  const Body body = test::make_body(settings, rest);
  for (const std::size_t one : {std::size_t{0}, std::size_t{7}, std::size_t{8}, rest.size() - 1}) {
    Particles particles = particles_at(rest, r, body.material.mass);
    particles.set_velocity(one, {0, 10, 0});
    expect_same_last_words(settings, rest, particles, 1e-3);
    std::reverse(particles.id.begin(), particles.id.end());
    expect_same_last_words(settings, rest, particles, 1e-3);
  }
}

TEST(Failures, NameTheSameParticleThatIsNotFinite) {
  const Points rest = test::fcc_box(5, 5, 25, r);
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  for (const double damping : {0.0, 0.5})
    for (const double value : {nan, inf, -inf}) {
      Settings settings = test::box_scene(25);
      settings.material.damping = damping;
      const Body body = test::make_body(settings, rest);
      Particles particles = particles_at(rest, r, body.material.mass);
      particles.set_velocity(100, {0, 0, value});
      expect_same_last_words(settings, rest, particles, 1e-3);
    }
}

TEST(Failures, NameAParticleWhereSinglePrecisionHardlyResolvesTheSpeed) {
  const Points rest = test::fcc_box(5, 5, 25, r);
  Settings settings = test::unbound(test::in(Precision::binary32, test::box_scene(25)));
  KeyDefinition end = test::bend_key(1, 0);
  end.translation = {2000, 0, 0};  // 200 r in each step
  settings.tracks = {test::track("lower", {test::bend_key(0, 0), end})};
  settings.tracks[0].interpolation = Interpolation::linear;
  const double step = 1e-3, most = 0.25 * r / step;
  for (int k = 0; k < 200; ++k) {
    Particles particles = particles_at(rest, r, test::material_of(settings).mass);
    const Vec3 velocity(2000 + most * (1 - 2e-6 * k), 0, 0);
    for (std::size_t i = 0; i < rest.size(); ++i) particles.set_velocity(i, velocity);
    const std::string words = last_words(settings, rest, particles, step, 1);
    EXPECT_TRUE(words.empty() || words.find(" on bone 'lower' moved") != std::string::npos)
        << words;
  }
}

TEST(Failures, APositionThatIsNotFiniteIsRefusedAtOnce) {
  const Points rest = test::fcc_box(5, 5, 5, r);
  Particles particles = particles_at(rest, r, 1);
  particles.y[7] = std::nan("");
  for (const Precision precision : {Precision::binary64, Precision::binary32})
    test::expect_error(Exit::bad_input,
                       [&] {
                         test::simulation_from(test::in(precision, test::box_scene(25)), rest,
                                               particles, 1e-3);
                       },
                       {"particle 7 ", "not finite"});
}

TEST(Failures, NameTheSameStepOfARunThatIsUnstable) {
  const Points rest = test::fcc_box(5, 5, 25, r);
  const Settings settings = moving_scene();
  const Body body = test::make_body(settings, rest);
  const Particles particles = test::shaken(rest, body.material, 0.01 * r, 0.1);
  const double step = test::step_of(settings, body, 1.5);
  const std::string expected = last_words(test::with_cells(settings), rest, particles, step, 200);
  EXPECT_NE(expected, "");
  EXPECT_EQ(last_words(settings, rest, particles, step, 200), expected);
}

TEST(Steppers, TakeTheSameStepsWhereHoldsYield) {
  for (const BoneForce form : {BoneForce::paper, BoneForce::anchor})
    for (const double max_force : {0.02, 0.2}) {
      Settings settings = moving_scene();
      settings.binding.force = form;
      settings.binding.max_force = max_force;
      expect_same_steps(settings);
      Settings firm = settings;
      firm.binding.max_force.reset();
      const Points rest = test::fcc_box(7, 7, 25, r);
      Simulation yields = test::make_simulation(settings, rest),
                 holds = test::make_simulation(firm, rest);
      yields.advance(50), holds.advance(50);
      if (max_force < 0.1) {  // the other one is enough for most
        EXPECT_GT(test::largest_distance(yields.particles(), holds.particles()), 1e-3 * r);
      }
    }
}

}  // namespace sinew::steppers_test

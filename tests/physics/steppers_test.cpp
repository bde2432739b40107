// SPDX-License-Identifier: GPL-3.0-or-later
// Whole steps with lists and with cells: the same positions, velocities, forces and ledger to
// rounding, and the same message when a run fails.
#include <sinew/core/error.h>

#include <numeric>

#include "all_steppers.h"
#include "expect_error.h"

namespace sinew::steppers_test {

constexpr double r = 0.01;
constexpr Integrator integrators[] = {Integrator::symplectic_euler, Integrator::explicit_euler,
                                      Integrator::velocity_verlet};

/// Both steppers, from one start.
struct Both {
  Simulation lists, cells;
  double step;  ///< s

  Both(const Settings& settings, const Points& rest, const Particles& particles, double dt)
      : lists(test::simulation_from(settings, rest, particles, dt)),
        cells(test::simulation_from(test::with_cells(settings), rest, particles, dt)),
        step(dt) {}

  void step_until(std::int64_t steps) {
    while (lists.steps() < steps) lists.step(), cells.step();
  }
};

/// Energies to a part of the largest of them.
void expect_same_energies(Energies a, Energies b, double part) {
  const double ledger[2][6] = {
      {a.kinetic, a.gravity, a.pair, a.bone, a.work_of_bones, a.dissipation},
      {b.kinetic, b.gravity, b.pair, b.bone, b.work_of_bones, b.dissipation}};
  double scale = 0;
  for (const double energy : ledger[1]) scale = std::max(scale, std::abs(energy));
  for (int k = 0; k < 6; ++k) EXPECT_NEAR(ledger[0][k], ledger[1][k], part * scale) << k;
}

double largest_force_difference(const Points& a, const Points& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, (a[i] - b[i]).norm());
  return most;
}

void expect_same(Both& both, double part) {
  const Particles &a = both.lists.particles(), &b = both.cells.particles();
  const Material& material = both.cells.body().material;
  // Where nearly everything is at rest, a speed of a hundredth of a radius per step counts.
  const double slow = 0.01 * material.pair.r / both.step;
  const double speed = std::max(test::largest_speed(b), slow);
  EXPECT_LE(test::largest_distance(a, b), part * material.pair.r);
  EXPECT_LE(test::largest_difference_of_velocity(a, b), part * speed);
  const Forces &f = both.lists.forces(), &g = both.cells.forces();
  const double force = material.stiffness() * material.pair.r;
  EXPECT_LE(largest_force_difference(f.pair, g.pair), 4 * part * force);
  EXPECT_LE(largest_force_difference(f.damping, g.damping), 4 * part * material.damping * speed);
  EXPECT_LE(largest_force_difference(f.bone, g.bone), 4 * part * force);
  EXPECT_EQ(f.neighbors, g.neighbors);
  expect_same_energies(both.lists.energies(), both.cells.energies(), part);
}

/// In the middle of a bend and a twist, so that all is in motion from the first step.
Settings moving_scene() {
  Settings settings = test::box_scene(25);
  settings.binding.joint_zone = 2;
  KeyDefinition end = test::bend_key(0.3, 50);
  end.twist = 40;
  end.translation = {0.3 * r, 0, 0.5 * r};
  settings.tracks = {test::track("lower", {test::bend_key(-0.1, 0), test::bend_key(0.3, -10)}),
                     test::track("upper", {test::bend_key(-0.1, 0), end})};
  return settings;
}

/// After 1, 10 and 100 steps from a shaken start; rounding grows with the steps.
void expect_same_steps(const Settings& settings, double shake = 0.02 * r, double speed = 0.05,
                       double factor = 0.5, int last = 100) {
  const Points rest = test::fcc_box(7, 7, 25, r);
  const Body body = test::make_body(settings, rest);
  double step = test::step_of(settings, body, factor);
  if (step == 0) step = 1e-4;  // explicit Euler without damping has no limit
  Both both(settings, rest, test::shaken(rest, body.material, shake, speed), step);
  for (const int steps : {0, 1, 10, last}) {
    SCOPED_TRACE(steps);
    both.step_until(steps);
    expect_same(both, steps > 10 ? 2e-11 : 1e-12);
  }
}

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

/// The moving scene with every material that knows its neighbors at rest.
std::vector<std::pair<std::string, Settings>> solids() {
  std::vector<std::pair<std::string, Settings>> solids;
  const auto add = [&](const std::string& name, auto&& change) {
    Settings settings = moving_scene();
    settings.material.model = MaterialModel::bonded;
    change(settings.material);
    solids.emplace_back(name, settings);
  };
  add("bonded", [](MaterialOptions&) {});
  add("undamped", [](MaterialOptions& material) { material.damping = 0; });
  add("initial_neighbors", [](MaterialOptions& material) {
    material.model = MaterialModel::paper;
    material.cohesion = Cohesion::initial_neighbors;
  });
  add("bonded_volume", [](MaterialOptions& material) {
    material.model = MaterialModel::bonded_volume;
    material.poisson_ratio = 0.45;
  });
  add("breaking", [](MaterialOptions& material) { material.breaking_strain = 0.01; });
  add("breaking volumes", [](MaterialOptions& material) {
    material.model = MaterialModel::bonded_volume;
    material.breaking_strain = 0.01;
  });
  add("yielding", [](MaterialOptions& material) {
    material.yield_strain = 0.01;
    material.creep_rate = 100;
  });
  add("breaking and yielding", [](MaterialOptions& material) {
    material.yield_strain = 0.01;
    material.creep_rate = 100;
    material.breaking_strain = 0.012;
  });
  return solids;
}

int broken_bonds(const Simulation& simulation) {
  const auto broken = simulation.broken_bonds();
  return std::accumulate(broken.begin(), broken.end(), 0);
}

TEST(SteppersOfSolids, TakeTheSameSteps) {
  for (const auto& [name, settings] : solids())
    for (const Integrator integrator : integrators) {
      SCOPED_TRACE(name);
      Settings chosen = settings;
      chosen.solver.integrator = integrator;
      if (chosen.material.damping == 0 && integrator == Integrator::explicit_euler) continue;
      expect_same_steps(chosen);
    }
}

TEST(SteppersOfSolids, TakeTheSameStepsOfADisorderedBody) {
  for (const auto& [name, settings] : solids()) {
    SCOPED_TRACE(name);
    const Points rest = test::fcc_box(7, 7, 25, r);
    const Body body = test::make_body(settings, rest);
    Both both(settings, rest, test::shaken(rest, body.material, 0.8 * r, 0.1),
              test::step_of(settings, body, 0.1));
    for (const int steps : {1, 10}) {
      both.step_until(steps);
      expect_same(both, 1e-12);
      EXPECT_EQ(both.lists.broken_bonds(), both.cells.broken_bonds());
    }
  }
}

TEST(SteppersOfSolids, BreakTheSameBonds) {
  for (const auto& [name, settings] : solids()) {
    if (!settings.material.breaking_strain) continue;
    SCOPED_TRACE(name);
    const Points rest = test::fcc_box(7, 7, 25, r);
    const Body body = test::make_body(settings, rest);
    Both both(settings, rest, test::shaken(rest, body.material, 0.02 * r, 0.05),
              test::step_of(settings, body));
    both.step_until(200);
    EXPECT_GT(broken_bonds(both.cells), 20);
    EXPECT_EQ(both.lists.broken_bonds(), both.cells.broken_bonds());
    expect_same_energies(both.lists.energies(), both.cells.energies(), 1e-9);
  }
}

TEST(SteppersOfSolids, TakeTheSameStepsInAnyOrderAndPacking) {
  for (const auto& [name, settings] : solids()) {
    SCOPED_TRACE(name);
    const Points rest = test::hcp_ball(7, r);
    const Body body = test::make_body(settings, rest);
    std::vector<std::size_t> order(rest.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::shuffle(order.begin(), order.end(), std::mt19937(3));
    Both both(settings, rest,
              test::reordered(test::shaken(rest, body.material, 0.02 * r, 0.05), order),
              test::step_of(settings, body));
    both.step_until(50);
    expect_same(both, 1e-11);
  }
}

TEST(SteppersOfSolids, SeparateCoincidentParticlesAlike) {
  for (const auto& [name, settings] : solids()) {
    SCOPED_TRACE(name);
    const Points rest = test::fcc_box(5, 5, 25, r);
    const Body body = test::make_body(settings, rest);
    Particles particles = particles_at(rest, r, body.material.mass);
    for (std::size_t i = 1; i < rest.size(); i += 4)
      particles.set_position(i, particles.position(i - 1));
    Both both(settings, rest, particles, test::step_of(settings, body, 0.05));
    expect_same(both, 1e-12);
    both.step_until(5);
    expect_same(both, 1e-12);
  }
}

TEST(SteppersOfSolids, AreCloseInSinglePrecision) {
  for (const auto& [name, settings] : solids()) {
    if (settings.material.breaking_strain) continue;  // rounding decides what breaks first
    SCOPED_TRACE(name);
    const Points rest = test::fcc_box(7, 7, 25, r);
    const Body body = test::make_body(settings, rest);
    const double step = test::step_of(settings, body);
    const Particles start = test::shaken(rest, body.material, 0.02 * r, 0.05);
    Simulation floats =
        test::simulation_from(test::in(Precision::binary32, settings), rest, start, step);
    Simulation cells = test::simulation_from(test::with_cells(settings), rest, start, step);
    while (cells.steps() < 100) floats.step(), cells.step();
    EXPECT_LT(test::largest_distance(floats.particles(), cells.particles()), 1e-4 * r);
    expect_same_energies(floats.energies(), cells.energies(), 1e-4);
  }
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
    EXPECT_TRUE(words.empty() || words.find("particle 0 on") != std::string::npos) << words;
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

}  // namespace sinew::steppers_test

// SPDX-License-Identifier: GPL-3.0-or-later
// Lists and cells side by side, from one start.
#pragma once

#include "support/all_steppers.h"

namespace sinew::both_steppers {

inline constexpr double r = 0.01;
inline constexpr Integrator integrators[] = {
    Integrator::symplectic_euler, Integrator::explicit_euler, Integrator::velocity_verlet};

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
inline void expect_same_energies(Energies a, Energies b, double part) {
  const double ledger[2][6] = {
      {a.kinetic, a.gravity, a.pair, a.bone, a.work_of_bones, a.dissipation},
      {b.kinetic, b.gravity, b.pair, b.bone, b.work_of_bones, b.dissipation}};
  double scale = 0;
  for (const double energy : ledger[1]) scale = std::max(scale, std::abs(energy));
  for (int k = 0; k < 6; ++k) EXPECT_NEAR(ledger[0][k], ledger[1][k], part * scale) << k;
}

inline double largest_force_difference(const Points& a, const Points& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, (a[i] - b[i]).norm());
  return most;
}

inline void expect_same(Both& both, double part) {
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
inline Settings moving_scene() {
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
inline void expect_same_steps(const Settings& settings, double shake = 0.02 * r,
                              double speed = 0.05, double factor = 0.5, int last = 100) {
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

}  // namespace sinew::both_steppers

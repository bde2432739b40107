// SPDX-License-Identifier: GPL-3.0-or-later
// How fast each integrator converges to motions known in closed form as its step is halved.
//
// Both Eulers are of first order. Velocity Verlet is of second order without damping; its damping
// uses the velocity of half a step before, which makes it first order.
#include <gtest/gtest.h>
#include <array>
#include <complex>
#include <functional>

#include "support/all_steppers.h"

namespace sinew::convergence_test {

constexpr double r = 0.01;

/// A free, damped oscillator, x'' + 2 g x' + w^2 x = 0.
struct Oscillator {
  double w2 = 0;  ///< 1/s^2
  double g = 0;   ///< 1/s
  double x = 0;   ///< initially, m
  double v = 0;   ///< initially, m/s

  double frequency() const { return std::sqrt(w2); }
  /// Place and velocity at a time (s).
  std::array<double, 2> at(double time) const {
    const std::complex<double> root = std::sqrt(std::complex<double>(g * g - w2, 0)),
                               slow = -g + root, fast = -g - root;
    const auto a = (v - fast * x) / (slow - fast), b = x - a;
    const auto first = a * std::exp(slow * time), second = b * std::exp(fast * time);
    return {(first + second).real(), (slow * first + fast * second).real()};
  }
};

/// A simulation of it, and how to read its state.
struct Model {
  std::string name;
  Settings settings;
  Points rest;
  Particles start;
  Oscillator oscillator;
  std::function<std::array<double, 2>(const Simulation&)> read;
};

/// Distance from the true state after 0.8 of a period, in initial amplitudes.
double error(const Model& model, int steps) {
  const Oscillator& truth = model.oscillator;
  const double time = 0.8 * 2 * pi / truth.frequency();
  Simulation simulation =
      test::simulation_from(model.settings, model.rest, model.start, time / steps);
  while (simulation.steps() < steps) simulation.step();
  const auto [x, v] = model.read(simulation);
  const auto [true_x, true_v] = truth.at(time);
  return std::hypot(x - true_x, (v - true_v) / truth.frequency()) / (0.1 * r);
}

void expect_order(const Model& model, double order, int steps = 400) {
  const double coarse = error(model, steps), middle = error(model, 2 * steps),
               fine = error(model, 4 * steps);
  EXPECT_NEAR(std::log2(coarse / middle), order, 0.1) << model.name << ", error " << coarse;
  EXPECT_NEAR(std::log2(middle / fine), order, 0.1) << model.name << ", error " << middle;
  EXPECT_LT(fine, 0.01) << model.name;
}

/// Two bonded particles about their middle: springs and damping act on the distance.
Model bonded_pair(double damping) {
  Model model;
  model.name = "bonded pair";
  model.settings = test::unbound(test::box_scene(9));
  model.settings.material.model = MaterialModel::bonded;
  model.settings.material.isotropic = false;  // no factors: two particles are no solid
  model.settings.material.damping = damping;
  model.rest = {{-r, 0, 0}, {r, 0, 0}};
  const Material material = test::material_of(model.settings);
  model.oscillator = {2 * material.bond.stiffness / material.mass, material.damping / material.mass,
                      0.1 * r, 0};
  model.start = particles_at({{-1.05 * r, 0, 0}, {1.05 * r, 0, 0}}, r, material.mass);
  model.read = [](const Simulation& simulation) {
    const Particles& now = simulation.particles();
    return std::array{now.x[1] - now.x[0] - 2 * r, now.u[1] - now.u[0]};
  };
  return model;
}

/// One particle beside a bone that moves sideways at constant speed: the radial spring.
Model beside_a_bone(double damping) {
  Model model;
  model.name = "beside a bone";
  model.settings = test::box_scene(25);
  model.settings.binding.bone_damping = damping;
  KeyDefinition begin = test::bend_key(-10, 0), end = test::bend_key(10, 0);
  const double speed = 0.2;
  begin.translation = {-10 * speed, 0, 0}, end.translation = {10 * speed, 0, 0};
  model.settings.tracks = {test::track("lower", {begin, end})};
  model.settings.tracks[0].interpolation = Interpolation::linear;
  model.rest = {{3 * r, 0, 0.05}};
  const Body body = test::make_body(model.settings, model.rest);
  const BoneSprings& springs = body.springs[0];
  const double m = body.material.mass;
  model.oscillator = {springs.radial / m, springs.damping / m / 2, 0.1 * r, -speed};
  model.start = particles_at({{3.1 * r, 0, 0.05}}, r, m);
  model.read = [speed](const Simulation& simulation) {
    const Particles& now = simulation.particles();
    return std::array{now.x[0] - 3 * r - speed * simulation.time(), now.u[0] - speed};
  };
  return model;
}

/// One particle on a bone that slides along itself, under its own weight: the axial spring.
Model along_a_bone(double damping) {
  Model model = beside_a_bone(damping);
  model.name = "along a bone";
  model.settings.tracks.clear();
  model.rest = {{0, 0, 0.05}};
  const Body body = test::make_body(model.settings, model.rest);
  const BoneSprings& springs = body.springs[0];
  // Without a side, the radial spring pulls in every direction.
  const double m = body.material.mass, w2 = (springs.axial + springs.radial) / m, sag = 0.1 * r;
  model.settings.solver.gravity = {0, 0, -w2 * sag};
  model.oscillator = {w2, springs.damping / m / 2, sag, 0};
  model.start = particles_at(model.rest, r, m);
  model.read = [sag](const Simulation& simulation) {
    const Particles& now = simulation.particles();
    return std::array{now.z[0] - 0.05 + sag, now.w[0]};
  };
  return model;
}

Model by(Integrator integrator, Model model) {
  model.settings.solver.integrator = integrator;
  return model;
}

/// With every stepper that supports them.
std::vector<Model> with_both_steppers(const Model& model) {
  Model cells = model;
  cells.settings = test::with_cells(model.settings);
  cells.name += ", cells";
  return {model, cells};
}

std::vector<Model> damped() {
  std::vector<Model> models{bonded_pair(0.3)};
  for (const Model& model : {beside_a_bone(0.4), along_a_bone(0.4), beside_a_bone(2)})
    for (const Model& one : with_both_steppers(model)) models.push_back(one);
  return models;
}

std::vector<Model> undamped() {
  std::vector<Model> models{bonded_pair(0)};
  for (const Model& model : {beside_a_bone(0), along_a_bone(0)})
    for (const Model& one : with_both_steppers(model)) models.push_back(one);
  return models;
}

TEST(Convergence, OfSymplecticEulerIsOfFirstOrder) {
  for (const Model& model : damped()) expect_order(by(Integrator::symplectic_euler, model), 1);
  for (const Model& model : undamped()) expect_order(by(Integrator::symplectic_euler, model), 1);
}

TEST(Convergence, OfExplicitEulerIsOfFirstOrder) {
  for (const Model& model : damped()) expect_order(by(Integrator::explicit_euler, model), 1, 1600);
  for (const Model& model : undamped())
    expect_order(by(Integrator::explicit_euler, model), 1, 1600);
}

TEST(Convergence, OfVelocityVerletIsOfSecondOrderWithoutDamping) {
  for (const Model& model : undamped()) expect_order(by(Integrator::velocity_verlet, model), 2);
}

TEST(Convergence, OfVelocityVerletIsOfFirstOrderWithDamping) {
  for (const Model& model : damped()) expect_order(by(Integrator::velocity_verlet, model), 1);
}

TEST(Convergence, InSinglePrecisionIsTheSameUntilRounding) {
  for (Model model : {beside_a_bone(0.4), along_a_bone(0.4)}) {
    model.settings = test::in(Precision::binary32, model.settings);
    for (const Integrator integrator : {Integrator::symplectic_euler, Integrator::velocity_verlet})
      expect_order(by(integrator, model), 1, 100);
  }
}

}  // namespace sinew::convergence_test

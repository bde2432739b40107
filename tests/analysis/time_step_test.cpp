// SPDX-License-Identifier: GPL-3.0-or-later
// Step limits from both sides: noise on a body at rest stays small just below, and grows above.
#include <sinew/analysis/time_step.h>

#include <gtest/gtest.h>

#include <sinew/scene/prepare.h>

#include "support/expect_error.h"
#include "support/world.h"

namespace sinew::time_step_test {

constexpr double r = 0.01, noise = 1e-9;  // m/s

const Points& bar() {
  static const Points points = test::fcc_box(11, 11, 25, r);
  return points;
}

Settings scene(Integrator integrator, DampingForm form, double damping) {
  Settings settings = test::unbound(test::box_scene(25));
  settings.solver.integrator = integrator;
  settings.material.damping_form = form;
  settings.material.damping = damping;
  return settings;
}

double limit_of(const Settings& settings, const Points& rest) {
  const Body body = test::make_body(settings, rest);
  return step_limit(settings.solver.integrator, body.material, body.springs);
}

/// Returns how much noise has grown after `steps` at `fraction` of the limit.
double growth(const Settings& settings, double fraction, int steps, const Points& rest = bar()) {
  const Particles start = test::shaken(rest, test::material_of(settings), 0, noise);
  Simulation simulation =
      test::simulation_from(settings, rest, start, fraction * limit_of(settings, rest));
  try {
    for (int step = 0; step < steps; ++step) simulation.step();
  } catch (const Error&) {
    return 1 / noise;
  }
  return test::largest_speed(simulation.particles()) / test::largest_speed(start);
}

void expect_limit(const Settings& settings, int steps) {
  EXPECT_LT(growth(settings, 0.97, steps), 10);
  EXPECT_GT(growth(settings, 1.05, steps), 1e3);
}

constexpr DampingForm forms[] = {DampingForm::paper, DampingForm::symmetric, DampingForm::central};

TEST(StepLimit, OfSymplecticEulerHoldsFromBothSides) {
  for (const DampingForm form : forms)
    for (const double damping : {0.0, 0.5, 2.0})
      expect_limit(scene(Integrator::symplectic_euler, form, damping), 120);
}

TEST(StepLimit, OfVelocityVerletHoldsFromBothSides) {
  for (const DampingForm form : forms)
    expect_limit(scene(Integrator::velocity_verlet, form, 0.5), 120);
}

TEST(StepLimit, HoldsFromBothSidesOnBones) {
  for (const auto& [integrator, force] : {std::pair(Integrator::symplectic_euler, BoneForce::paper),
                                          {Integrator::velocity_verlet, BoneForce::anchor}})
    for (const DampingForm form : forms) {
      Settings settings = test::box_scene(25);
      settings.solver.integrator = integrator;
      settings.material.damping_form = form;
      settings.binding.force = force;
      expect_limit(settings, 120);
    }
}

TEST(StepLimit, CountsTheSurfaceWhereDampingIsStrong) {
  for (const DampingForm form : forms)
    for (const Points& rest : {test::hcp_ball(6, r), test::fcc_box(5, 5, 25, r)})
      for (const double damping : {5.0, 20.0})
        EXPECT_LT(growth(scene(Integrator::symplectic_euler, form, damping), 0.97, 200, rest), 10);
  EXPECT_GT(growth(scene(Integrator::symplectic_euler, DampingForm::paper, 20), 1.05, 200), 1e3);
}

TEST(StepLimit, HasItsClosedForm) {
  Settings settings = test::box_scene();
  const Body body = test::make_body(settings, test::fcc_box(11, 11, 49, r));
  const double k = body.material.stiffness(), m = body.material.mass;
  const double C = body.material.damping;
  double stiffest = 0, damping = 0;
  for (const BoneSprings& bone : body.springs) {
    stiffest = std::max({stiffest, bone.radial, bone.twist, bone.axial});
    damping = std::max(damping, bone.damping);
  }
  const double w2 = (8 * k + stiffest) / m, g = (4.0 / 3 * C + damping) / m;
  EXPECT_DOUBLE_EQ(step_limit(Integrator::symplectic_euler, body.material, body.springs),
                   (std::sqrt(g * g + 4 * w2) - g) / w2);
  settings.material.damping = 0;
  const Material undamped = test::material_of(settings);
  EXPECT_NEAR(step_limit(Integrator::symplectic_euler, undamped, {}), 0.70711 * std::sqrt(m / k),
              1e-5 * std::sqrt(m / k));
}

TEST(StepLimit, UsesTheStifferOfContactAndTension) {
  Settings settings = test::box_scene();
  const double standard = limit_of(settings, bar());
  settings.material.lambda = 4;
  settings.material.damping = 0.25;  // relative to contact, which is a quarter of it
  settings = test::unbound(settings);
  const Material material = test::material_of(settings);
  EXPECT_DOUBLE_EQ(material.stiffness(), 4 * material.pair.contact_stiffness());
  EXPECT_LT(limit_of(settings, bar()), 0.6 * standard);
  EXPECT_LT(growth(settings, 0.97, 100), 10);
}

// Near the explicit limits noise grows slowly, and only the infinite packing has the worst mode of
// the paper's and the symmetric damping: the body's own limits are higher by up to the given
// factor.
TEST(StepLimit, OfExplicitEulerIsSetByTheLattice) {
  struct Case {
    DampingForm form;
    double damping, divisor, above;
  };
  for (const Case& one : {Case{DampingForm::paper, 3, 8, 1.15},
                          {DampingForm::symmetric, 3, 8, 1.4},
                          {DampingForm::central, 5, 12, 1.05}}) {
    const Settings settings = scene(Integrator::explicit_euler, one.form, one.damping);
    const Material material = test::material_of(settings);
    EXPECT_DOUBLE_EQ(limit_of(settings, bar()),
                     material.damping / (one.divisor * material.stiffness()));
    EXPECT_LT(growth(settings, 0.97, 400), 10);
    EXPECT_GT(growth(settings, one.above, 500), 1e3);
  }
}

TEST(StepLimit, OfExplicitEulerIsSetByStrongDamping) {
  for (const DampingForm form : forms) {
    const Settings settings = scene(Integrator::explicit_euler, form, 20);
    const Material material = test::material_of(settings);
    EXPECT_LT(limit_of(settings, bar()), material.damping / (12 * material.stiffness()));
    EXPECT_LT(growth(settings, 0.97, 250), 10);
    EXPECT_GT(growth(settings, 1.1, 250), 1e3);
  }
}

TEST(StepLimit, OfExplicitEulerIsSetByWeaklyDampedBones) {
  // One particle alone, bound by an anchor: a mode that only the bone damps.
  Settings settings = scene(Integrator::explicit_euler, DampingForm::paper, 5);
  settings.binding.force = BoneForce::anchor;
  settings.binding.stiffness = 1;
  settings.binding.bone_damping = 0.02;
  const Points one = {{0.05, 0, 0.1}};
  const Body body = test::make_body(settings, one);
  const BoneSprings& bone = body.springs[0];
  ASSERT_DOUBLE_EQ(limit_of(settings, one), bone.damping / bone.radial);
  EXPECT_LT(growth(settings, 0.97, 200000, one), 10);
  EXPECT_GT(growth(settings, 1.05, 200000, one), 1e3);
}

TEST(StepLimit, ThereIsNoneForExplicitEulerWithoutDamping) {
  const Settings settings = scene(Integrator::explicit_euler, DampingForm::paper, 0);
  EXPECT_EQ(limit_of(settings, bar()), 0);
  test::expect_bad_input(
      [&] { choose_step(settings.solver, 0, 1.0 / 30); },
      {"explicit_euler", "no stable time step", "; ", "material.damping", "symplectic_euler"});
  Settings undamped_bones = test::box_scene(25);
  undamped_bones.solver.integrator = Integrator::explicit_euler;
  undamped_bones.binding.bone_damping = 0;
  EXPECT_EQ(limit_of(undamped_bones, bar()), 0);
}

/// A particle on its bone: |1 + i w step| per step is exp(w^2 step time / 2) in all.
TEST(StepLimit, OfExplicitEulerWithoutDampingLetsMotionsGrowByE) {
  Settings settings = test::box_scene(25);
  settings.solver.integrator = Integrator::explicit_euler;
  settings.binding.bone_damping = 0;
  Body body = test::make_body(settings, {{0.05, 0, 0.1}});
  const double duration = 1000, w2 = body.springs[0].stiffest() / body.material.mass;
  const double step = explicit_step_for(body, {}, duration);
  EXPECT_NEAR(std::pow(1 + w2 * step * step, duration / step / 2), std::exp(1.0), 1e-3);
  body.springs.clear();
  body.material.damping = 0;  // now the packing grows, whose w^2 is 8 k / m, and 9 at surfaces
  const double w2_of_packing = 8 * body.material.stiffness() / body.material.mass;
  EXPECT_NEAR(explicit_step_for(body, {}, duration), 2 / (w2_of_packing * duration),
              0.15 * 2 / (w2_of_packing * duration));
}

TEST(ChooseStep, DividesTheFrameExactlyAndIsNeverLonger) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(1e-3, 1);
  for (int trial = 0; trial < 1000; ++trial) {
    SolverSettings solver;
    const double limit = 0.1 * unit(random), interval = unit(random);
    const StepChoice choice = choose_step(solver, limit, interval);
    EXPECT_DOUBLE_EQ(choice.step * choice.per_frame, interval);
    EXPECT_LE(choice.step, 0.5 * limit * (1 + 1e-11));
    EXPECT_TRUE(choice.per_frame == 1 || interval / (choice.per_frame - 1) > 0.5 * limit);
    EXPECT_DOUBLE_EQ(choice.factor(), choice.step / limit);
  }
}

TEST(ChooseStep, TakesTheStepAskedForAsAnUpperBound) {
  SolverSettings solver;
  solver.time_step = 0.003;
  EXPECT_EQ(choose_step(solver, 1, 0.01).per_frame, 4);
  EXPECT_DOUBLE_EQ(choose_step(solver, 1, 0.01).step, 0.0025);
  EXPECT_EQ(choose_step(solver, 0, 0.01).per_frame, 4) << "even where no step is stable";
  solver.time_step = 0.05;
  EXPECT_EQ(choose_step(solver, 1, 0.01).per_frame, 1);
}

TEST(ChooseStep, DoesNotMakeAnExactStepShorterByRounding) {
  for (const int steps : {3, 7, 49, 1000, 12345}) {
    SolverSettings solver;
    solver.time_step = (1.0 / 30) / steps;
    EXPECT_EQ(choose_step(solver, 1, 1.0 / 30).per_frame, steps);
  }
}

TEST(ChooseStep, RefusesFramesOfBillionsOfSteps) {
  SolverSettings solver;
  solver.time_step = 1e-12;
  test::expect_bad_input([&] { choose_step(solver, 1, 1); }, {"steps", "; ", "time_step"});
  solver.time_step = 1e-320;
  test::expect_bad_input([&] { choose_step(solver, 1, 1); }, {"steps", "; "});
}

}  // namespace sinew::time_step_test

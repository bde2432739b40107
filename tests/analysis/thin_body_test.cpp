// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies of few planes withstand longer steps than the infinite packing: the factor is bounded from
// both sides.
#include <gtest/gtest.h>

#include <sinew/analysis/time_step.h>

#include "support/world.h"

namespace sinew::thin_body_test {

constexpr double r = 0.01, noise = 1e-9;  // m/s

Settings scene(MaterialModel model, DampingForm form, double damping) {
  Settings settings = test::box_scene(25);
  settings.material.model = model;
  settings.material.damping_form = form;
  settings.material.damping = damping;
  return settings;
}

/// Returns how much noise has grown after 250 steps.
double growth(const Settings& settings, const Points& rest, double step) {
  const Particles start = test::shaken(rest, test::material_of(settings), 0, noise);
  Simulation simulation = test::simulation_from(settings, rest, start, step);
  try {
    for (int n = 0; n < 250; ++n) simulation.step();
  } catch (const Error&) {
    return 1 / noise;
  }
  return test::largest_speed(simulation.particles()) / test::largest_speed(start);
}

void expect_limit(const Settings& settings, const Points& rest) {
  const Body body = test::make_body(settings, rest);
  const double limit = step_limit(settings.solver.integrator, body);
  EXPECT_LT(growth(settings, rest, limit), 10);
  EXPECT_GT(growth(settings, rest, 1.05 * limit), 1e3);
}

TEST(ThinBody, WithstandsTheStepOfPowerIteration) {
  for (const int planes : {2, 3, 4}) {
    const Points rest = test::fcc_box(planes, planes, 25, r);
    for (const MaterialModel model :
         {MaterialModel::paper, MaterialModel::bonded, MaterialModel::bonded_volume})
      for (const DampingForm form :
           {DampingForm::paper, DampingForm::symmetric, DampingForm::central})
        for (const double damping : {0.0, 0.5, 5.0}) {
          SCOPED_TRACE(testing::Message()
                       << planes << " planes, model " << static_cast<int>(model) << ", damping "
                       << static_cast<int>(form) << ' ' << damping);
          expect_limit(scene(model, form, damping), rest);
        }
  }
}

TEST(ThinBody, WithstandsALongerStepThanThePacking) {
  const Settings settings = scene(MaterialModel::paper, DampingForm::paper, 0.5);
  const Body body = test::make_body(settings, test::fcc_box(3, 3, 25, r));
  EXPECT_GT(step_limit(Integrator::symplectic_euler, body),
            1.05 * step_limit(Integrator::symplectic_euler, body.material, body.springs));
}

TEST(ThinBody, WithstandsItWithVelocityVerletToo) {
  Settings settings = scene(MaterialModel::paper, DampingForm::paper, 0.5);
  settings.solver.integrator = Integrator::velocity_verlet;
  expect_limit(settings, test::fcc_box(3, 11, 25, r));
}

TEST(ThinBody, WithoutForcesHasTheLimitOfThePacking) {
  Settings settings = test::unbound(scene(MaterialModel::paper, DampingForm::paper, 0.5));
  settings.binding.bone_damping = 0;
  const Body body = test::make_body(settings, {{0.05, 0, 0.1}});
  EXPECT_EQ(step_limit(Integrator::symplectic_euler, body),
            step_limit(Integrator::symplectic_euler, body.material, body.springs));
}

TEST(ThinBody, HasNoParticleUnderTwoLayers) {
  EXPECT_TRUE(is_thin(test::nearest(test::fcc_box(4, 11, 11, r), r)));
  EXPECT_FALSE(is_thin(test::nearest(test::fcc_box(5, 11, 11, r), r)));
  EXPECT_FALSE(is_thin({}));
}

TEST(ThinBody, LeavesTheClosedFormsToThickBodies) {
  const Settings settings = test::box_scene(25);
  const Body body = test::make_body(settings, test::fcc_box(11, 11, 25, r));
  EXPECT_EQ(step_limit(Integrator::symplectic_euler, body),
            step_limit(Integrator::symplectic_euler, body.material, body.springs));
}

}  // namespace sinew::thin_body_test

// SPDX-License-Identifier: GPL-3.0-or-later
// The time in which damping stops a spinning body, beside the moment of the damping forces that a
// simulation finds.
#include <sinew/analysis/spin.h>

#include <gtest/gtest.h>
#include <cmath>

#include <sinew/stepping/simulation.h>
#include "support/world.h"

namespace sinew::spin_test {

constexpr double r = 0.01;

/// A free body of these layers along its axes.
Body body_of(MaterialModel model, DampingForm form, const std::array<int, 3>& layers) {
  Settings settings = test::box_scene();
  settings.material.model = model;
  settings.material.damping_form = form;
  return test::make_body(test::unbound(settings),
                         test::fcc_box(layers[0], layers[1], layers[2], r));
}

/// The rate at which a rotation w loses angular momentum along itself, 1/s.
double rate_in_simulation(const Body& body, const Vec3& w) {
  Particles particles = particles_at(body.rest, r, body.material.mass);
  Vec3 center = Vec3::Zero();
  for (const Vec3& place : body.rest) center += place / static_cast<double>(body.rest.size());
  double spin = 0;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const Vec3 velocity = w.cross(particles.position(i) - center);
    particles.set_velocity(i, velocity);
    spin += body.material.mass * velocity.squaredNorm();
  }
  Simulation simulation(body, {}, particles, Stepping{.step = 1e-6});
  double power = 0;
  for (std::size_t i = 0; i < particles.size(); ++i)
    power += simulation.forces().damping[i].dot(particles.velocity(i));
  return -power / spin;
}

TEST(Spin, StopsAsFastAsTheMomentOfTheDampingSays) {
  for (const MaterialModel model :
       {MaterialModel::paper, MaterialModel::bonded, MaterialModel::bonded_volume})
    for (const DampingForm form : {DampingForm::paper, DampingForm::symmetric}) {
      const Body body = body_of(model, form, {7, 9, 21});
      double fastest = 0;
      for (int axis = 0; axis < 3; ++axis)
        fastest = std::max(fastest, rate_in_simulation(body, Vec3::Unit(axis)));
      EXPECT_NEAR(spin_time(body) * fastest, 1, 1e-6) << static_cast<int>(model);
    }
}

TEST(Spin, GoesOnWithCentralDampingAndWithoutAny) {
  const Body central = body_of(MaterialModel::bonded, DampingForm::central, {7, 9, 21});
  EXPECT_TRUE(std::isinf(spin_time(central)));
  EXPECT_NEAR(rate_in_simulation(central, {0.3, 0.5, 1}), 0, 1e-9);
  Body undamped = body_of(MaterialModel::bonded, DampingForm::paper, {5, 5, 5});
  undamped.material.damping = 0;
  EXPECT_TRUE(std::isinf(spin_time(undamped)));
}

}  // namespace sinew::spin_test

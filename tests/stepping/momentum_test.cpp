// SPDX-License-Identifier: GPL-3.0-or-later
// What pair forces and the three dampings conserve, and their decay rates.
#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>
#include <algorithm>

#include <sinew/body/forces.h>

#include "support/world.h"

namespace sinew::momentum_test {

constexpr double r = 0.01;

Material material_with(DampingForm form) {
  Settings settings = test::box_scene();
  settings.material.damping_form = form;
  return test::material_of(settings);
}

Forces forces_on(const Particles& particles, const Material& material) {
  Forces forces;
  pair_forces(particles, material, forces);
  return forces;
}

Particles shaken_box(const Material& material) {
  return test::shaken(test::fcc_box(7, 7, 15, r), material, 0.6 * r, 1);
}

Vec3 sum(const Points& forces) {
  Vec3 total = Vec3::Zero();
  for (const Vec3& force : forces) total += force;
  return total;
}

Vec3 moment(const Particles& particles, const Points& forces) {
  Vec3 total = Vec3::Zero();
  for (std::size_t i = 0; i < forces.size(); ++i) total += particles.position(i).cross(forces[i]);
  return total;
}

double sum_of_norms(const Points& forces) {
  double total = 0;
  for (const Vec3& force : forces) total += force.norm();
  return total;
}

/// The body as it is, each particle with the velocity it has there.
template <class Field>
Particles moving(const Points& points, const Material& material, Field&& velocity) {
  Particles particles = particles_at(points, r, material.mass);
  for (std::size_t i = 0; i < points.size(); ++i) particles.set_velocity(i, velocity(points[i]));
  return particles;
}

TEST(Momentum, PairForcesAndTheirMomentsSumToZero) {
  const Material material = material_with(DampingForm::paper);
  const Particles particles = shaken_box(material);
  const Forces forces = forces_on(particles, material);
  const double scale = sum_of_norms(forces.pair);
  EXPECT_LT(sum(forces.pair).norm(), 1e-14 * scale);
  EXPECT_LT(moment(particles, forces.pair).norm(), 1e-14 * scale);
}

TEST(Momentum, SymmetricAndCentralDampingKeepIt) {
  for (const DampingForm form : {DampingForm::symmetric, DampingForm::central}) {
    const Material material = material_with(form);
    const Points damping = forces_on(shaken_box(material), material).damping;
    EXPECT_LT(sum(damping).norm(), 1e-13 * sum_of_norms(damping));
  }
}

TEST(Momentum, OnlyCentralDampingKeepsAngularMomentum) {
  for (const DampingForm form : {DampingForm::symmetric, DampingForm::central}) {
    const Material material = material_with(form);
    const Particles particles = shaken_box(material);
    const Points damping = forces_on(particles, material).damping;
    const double relative = moment(particles, damping).norm() / sum_of_norms(damping);
    EXPECT_EQ(relative < 1e-14, form == DampingForm::central) << relative;
  }
}

TEST(Momentum, PaperDampingDoesNotKeepIt) {
  const Material material = material_with(DampingForm::paper);
  const Points damping = forces_on(shaken_box(material), material).damping;
  EXPECT_GT(sum(damping).norm(), 1e-5 * sum_of_norms(damping));
}

TEST(Damping, LeavesRigidTranslationAlone) {
  for (const DampingForm form :
       {DampingForm::paper, DampingForm::symmetric, DampingForm::central}) {
    const Material material = material_with(form);
    const Points points = positions_of(shaken_box(material));
    const auto translation = [](const Vec3&) { return Vec3(1, -2, 3); };
    const Particles particles = moving(points, material, translation);
    for (const Vec3& force : forces_on(particles, material).damping)
      EXPECT_LT(force.norm(), 1e-14 * material.damping);
  }
}

TEST(Damping, OnlyCentralLeavesRigidRotationAlone) {
  for (const DampingForm form :
       {DampingForm::paper, DampingForm::symmetric, DampingForm::central}) {
    const Material material = material_with(form);
    const Points points = positions_of(shaken_box(material));
    const auto rotation = [](const Vec3& x) { return Vec3(1, -2, 3).cross(x).eval(); };
    const Particles particles = moving(points, material, rotation);
    const double total = sum_of_norms(forces_on(particles, material).damping);
    EXPECT_EQ(total < 1e-12 * material.damping, form == DampingForm::central);
  }
}

TEST(Damping, TakesEnergyNeverGivesIt) {
  for (const DampingForm form : {DampingForm::symmetric, DampingForm::central}) {
    const Material material = material_with(form);
    for (unsigned seed = 0; seed < 20; ++seed) {
      const Particles particles =
          test::shaken(test::fcc_box(5, 5, 5, r), material, 0.6 * r, 1, seed);
      const Points damping = forces_on(particles, material).damping;
      double power = 0;
      for (std::size_t i = 0; i < particles.size(); ++i)
        power += damping[i].dot(particles.velocity(i));
      EXPECT_LT(power, 0);
    }
  }
}

/// The largest decay rate of a mode by damping alone, in C/m, by power iteration.
double largest_rate(const Points& points, DampingForm form) {
  const Material material = material_with(form);
  Particles particles = test::shaken(points, material, 0, 1);
  double rate = 0;
  for (int iteration = 0; iteration < 400; ++iteration) {
    const Points damping = forces_on(particles, material).damping;
    double before = 0, after = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      before += particles.velocity(i).squaredNorm();
      after += damping[i].squaredNorm();
    }
    rate = std::sqrt(after / before) / material.damping;
    for (std::size_t i = 0; i < points.size(); ++i)
      particles.set_velocity(i, -damping[i] / std::sqrt(after));
  }
  return rate;
}

/// The largest decay rate of a plane wave in FCC, in C/m: v = p cos(q.x) about a particle.
double rate_of_wave(const Points& ball, std::size_t middle, const Vec3& q, DampingForm form) {
  const Material material = material_with(form);
  Mat3 rates;
  for (int p = 0; p < 3; ++p) {
    const auto wave = [&](const Vec3& x) { return Vec3(std::cos(q.dot(x)) * Vec3::Unit(p)); };
    rates.col(p) = -forces_on(moving(ball, material, wave), material).damping[middle];
  }
  return Eigen::SelfAdjointEigenSolver<Mat3>(rates).eigenvalues()[2] / material.damping;
}

TEST(Damping, OfPlaneWavesIsAtMostTheRateOfTheModel) {
  const Points ball = test::fcc_ball(5, r);  // the neighbors' own counts matter too
  const auto middle = std::min_element(ball.begin(), ball.end(),
                                       [](auto& a, auto& b) { return a.norm() < b.norm(); }) -
                      ball.begin();
  std::mt19937 random(3);
  const double edge = 2 * pi / second_distance(r);  // X of the Brillouin zone
  for (const auto& [form, most] : {std::pair(DampingForm::paper, 4.0 / 3),
                                   {DampingForm::symmetric, 4.0 / 3},
                                   {DampingForm::central, 2.0 / 3}}) {
    EXPECT_NEAR(rate_of_wave(ball, middle, {edge, 0, 0}, form), most, 1e-12);
    for (int trial = 0; trial < 300; ++trial)
      EXPECT_LE(rate_of_wave(ball, middle, 3 * edge * test::random_vector(random), form),
                most + 1e-12);
  }
}

TEST(Damping, OfBodiesIsAtMostTheRateThatStepLimitsCountOn) {
  for (const Points& points : {test::fcc_box(11, 11, 15, r), test::fcc_box(5, 5, 25, r),
                               test::fcc_ball(7, r), test::hcp_ball(7, r)}) {
    EXPECT_LE(largest_rate(points, DampingForm::paper), 1.52);
    EXPECT_LE(largest_rate(points, DampingForm::symmetric), 1.52);
    EXPECT_LE(largest_rate(points, DampingForm::central), 0.87);
  }
}

}  // namespace sinew::momentum_test

// SPDX-License-Identifier: GPL-3.0-or-later
// The forces found with cells against the sums over all pairs.
#include <gtest/gtest.h>

#include <sinew/body/forces.h>
#include <sinew/core/parallel.h>

#include "support/world.h"

namespace sinew::pair_forces_test {

constexpr double r = 0.01;
constexpr DampingForm forms[] = {DampingForm::paper, DampingForm::symmetric, DampingForm::central};

struct Reference {
  Points pair, damping;
  std::vector<int> count;
  double energy = 0;
};

double equation_1(const PairForce& p, double d) {
  if (d < 2 * p.r) return p.k1 * (4 * p.r * p.r - d * d);
  return d >= p.a && d < p.b ? -p.k2 * (d - p.a) * (p.b - d) : 0;
}

/// Calls visit(i, j, d) for all ordered pairs nearer than b.
template <class Visit>
void all_pairs(const Particles& particles, double b, Visit&& visit) {
  for (std::size_t i = 0; i < particles.size(); ++i)
    for (std::size_t j = 0; j < particles.size(); ++j) {
      const double d = (particles.position(i) - particles.position(j)).norm();
      if (i != j && d < b) visit(i, j, d);
    }
}

Reference brute_force(const Particles& particles, const Material& material) {
  const std::size_t n = particles.size();
  const double C = material.damping;
  Reference sum{Points(n, Vec3::Zero()), Points(n, Vec3::Zero()), std::vector<int>(n, 0)};
  all_pairs(particles, material.pair.b, [&](auto i, auto, double) { ++sum.count[i]; });
  all_pairs(particles, material.pair.b, [&](auto i, auto j, double d) {
    const Vec3 e = (particles.position(i) - particles.position(j)) / d;
    const Vec3 relative = particles.velocity(i) - particles.velocity(j);
    const double mean = (1.0 / sum.count[i] + 1.0 / sum.count[j]) / 2;
    sum.pair[i] += equation_1(material.pair, d) * e;
    sum.energy += material.pair.potential(d) / 2;
    switch (material.damping_form) {
      case DampingForm::paper:
        sum.damping[i] -= C * relative / sum.count[i];
        break;
      case DampingForm::symmetric:
        sum.damping[i] -= C * mean * relative;
        break;
      case DampingForm::central:
      case DampingForm::rigid:
        sum.damping[i] -= C * mean * relative.dot(e) * e;
        break;
    }
  });
  return sum;
}

void expect_reference(const Particles& particles, const Material& material) {
  const Reference expected = brute_force(particles, material);
  Forces forces;
  pair_forces(particles, material, forces);
  const double scale = material.pair.k1 * r * r, damping_scale = material.damping;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    ASSERT_LT((forces.pair[i] - expected.pair[i]).norm(), 1e-12 * scale) << i;
    ASSERT_LT((forces.damping[i] - expected.damping[i]).norm(), 1e-12 * damping_scale) << i;
    ASSERT_EQ(forces.neighbors[i], expected.count[i]) << i;
  }
  EXPECT_NEAR(pair_energy(particles, material.pair), expected.energy,
              1e-12 * particles.size() * scale * r);
}

Material standard(DampingForm form = DampingForm::paper) {
  Settings settings = test::box_scene();
  settings.material.damping_form = form;
  return test::material_of(settings);
}

void expect_reference_for(const Points& points, double shake) {
  for (const DampingForm form : forms)
    expect_reference(test::shaken(points, standard(form), shake, 0.5), standard(form));
}

TEST(PairForces, EqualAllPairsAtRest) {
  // Slightly off rest: at rest itself both sums are rounding.
  expect_reference_for(test::fcc_box(7, 7, 15, r), 1e-6 * r);
  expect_reference_for(test::hcp_ball(7, r), 1e-6 * r);
}

TEST(PairForces, EqualAllPairsShakenAndShakenHard) {
  expect_reference_for(test::fcc_box(7, 7, 15, r), 0.2 * r);
  expect_reference_for(test::fcc_box(7, 7, 15, r), 2 * r);
  expect_reference_for(test::hcp_ball(7, r), 0.5 * r);
}

TEST(PairForces, EqualAllPairsCrushed) {
  const Points box = test::fcc_box(7, 7, 15, r);
  expect_reference_for(test::affine(box, 0.3 * Mat3::Identity()), 0.1 * r);
  expect_reference_for(test::affine(box, Vec3(1, 1, 0).asDiagonal()), 0.01 * r);
}

TEST(PairForces, EqualAllPairsSpreadOutAndFarFromTheOrigin) {
  const Points box = test::fcc_box(7, 7, 15, r);
  expect_reference_for(test::affine(box, 1.4 * Mat3::Identity()), 0.3 * r);
  expect_reference_for(test::affine(box, Mat3::Identity(), {-1e5, 1e5, 3e4}), 0.2 * r);
}

TEST(PairForces, DoNotActBeyondTheRange) {
  const Material material = standard();
  Particles particles = particles_at({{0, 0, 0}, {material.pair.b, 0, 0}, {5, 5, 5}}, r, 1);
  for (std::size_t i = 0; i < 3; ++i) particles.set_velocity(i, {1.0 * i, 2, 3});
  for (const DampingForm form : forms) {
    Forces forces;
    pair_forces(particles, standard(form), forces);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(forces.pair[i], Vec3::Zero());
      EXPECT_EQ(forces.damping[i], Vec3::Zero());
      EXPECT_EQ(forces.neighbors[i], 0);
    }
  }
}

TEST(PairForces, OfNoParticlesAreNone) {
  Forces forces;
  pair_forces({}, standard(), forces);
  EXPECT_TRUE(forces.pair.empty());
  EXPECT_EQ(pair_energy({}, standard().pair), 0);
}

TEST(PairForces, PushCoincidentParticlesApart) {
  const Material material = standard();
  for (const DampingForm form : forms) {
    Particles particles = particles_at({{1, 1, 1}, {1, 1, 1}}, r, 1);
    particles.set_velocity(0, {1, 1, 0});
    Forces forces;
    pair_forces(particles, standard(form), forces);
    EXPECT_DOUBLE_EQ(forces.pair[0].norm(), 4 * material.pair.k1 * r * r);
    EXPECT_EQ(forces.pair[0], -forces.pair[1]);
    EXPECT_TRUE(forces.damping[0].allFinite());
    EXPECT_EQ(forces.neighbors, (std::vector<int>{1, 1}));
  }
}

TEST(PairForces, SeparateCoincidentParticlesAlikeInAnyOrder) {
  const Particles particles = particles_at({{1, 1, 1}, {1, 1, 1}}, r, 1);
  Forces forces, swapped;
  pair_forces(particles, standard(), forces);
  pair_forces(test::reordered(particles, {1, 0}), standard(), swapped);
  EXPECT_EQ(forces.pair[0], swapped.pair[1]);
}

TEST(PairForces, AreMinusTheGradientOfTheEnergy) {
  const Material material = standard();
  const Particles particles = test::shaken(test::fcc_box(5, 5, 5, r), material, 0.3 * r, 0);
  Forces forces;
  pair_forces(particles, material, forces);
  const double h = 1e-7 * r;
  for (std::size_t i = 0; i < particles.size(); i += 7)
    for (int axis = 0; axis < 3; ++axis) {
      Particles ahead = particles, behind = particles;
      ahead.set_position(i, particles.position(i) + h * Vec3::Unit(axis));
      behind.set_position(i, particles.position(i) - h * Vec3::Unit(axis));
      const double slope =
          (pair_energy(ahead, material.pair) - pair_energy(behind, material.pair)) / (2 * h);
      EXPECT_NEAR(forces.pair[i][axis], -slope, 1e-5 * material.pair.k1 * r * r);
    }
}

TEST(PairForces, VanishOnTheLatticeWithoutPrestress) {
  for (const Points& points : {test::fcc_box(11, 11, 15, r), test::hcp_ball(9, r)}) {
    Forces forces;
    pair_forces(particles_at(points, r, 1), standard(), forces);
    for (const Vec3& force : forces.pair)
      EXPECT_LT(force.norm(), 1e-13 * standard().pair.contact_stiffness() * r * 12);
  }
}

TEST(PairForces, HaveTheSameBitsForEveryThreadCount) {
  for (const DampingForm form : forms) {
    const Material material = standard(form);
    const Particles particles = test::shaken(test::fcc_box(11, 11, 25, r), material, 0.5 * r, 1);
    Forces expected;
    pair_forces(particles, material, expected);
    const double energy = pair_energy(particles, material.pair);
    for (const int threads : {1, 2, 3, 8})
      with_threads(threads, [&] {
        Forces forces;
        pair_forces(particles, material, forces);
        EXPECT_EQ(forces.pair, expected.pair);
        EXPECT_EQ(forces.damping, expected.damping);
        EXPECT_EQ(pair_energy(particles, material.pair), energy);
      });
  }
}

}  // namespace sinew::pair_forces_test

// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/world/muscles.h>

#include <gtest/gtest.h>

#include <sinew/body/body.h>
#include <sinew/body/forces.h>

#include "support/expect_error.h"
#include "support/world.h"

namespace sinew::muscles_test {

constexpr double r = 0.01, S = 5000;
const Vec3 aslant = Vec3(1, -2, 3).normalized();

Muscle everywhere(const Points& rest, const Vec3& direction) {
  Muscle muscle;
  muscle.name = "biceps";
  muscle.direction = direction;
  muscle.strength = S;
  muscle.weights = weights_in(Region{}, rest);
  return muscle;
}

/// Muscle forces on a body at `now` at one level of activation.
struct Pulled {
  Points forces;
  FiberEnergy energy;

  Pulled(const Muscles& muscles, const Points& now, double level = 1, double rate = 0) {
    const std::size_t count = muscles.muscles.size();
    const Activations activations = {std::vector<double>(count, level),
                                     std::vector<double>(count, rate)};
    energy = muscle_forces(muscles, activations, particles_at(now, r, 1), forces);
  }
  Vec3 sum() const {
    Vec3 all = Vec3::Zero();
    for (const Vec3& force : forces) all += force;
    return all;
  }
  /// -sum f x^T: volume times Kirchhoff stress.
  Mat3 virial(const Points& now) const {
    Mat3 all = Mat3::Zero();
    for (std::size_t i = 0; i < now.size(); ++i) all -= forces[i] * now[i].transpose();
    return all;
  }
};

Points shaken(Points points, double shake) {
  std::mt19937 random(7);
  for (Vec3& point : points) point += shake * test::random_vector(random);
  return points;
}

std::uint32_t nearest_the_middle(const Points& points) {
  std::uint32_t best = 0;
  for (std::uint32_t i = 0; i < points.size(); ++i)
    if (points[i].norm() < points[best].norm()) best = i;
  return best;
}

// Muscle of one particle, so that the law holds for each: inner ones and those at the surface.
TEST(Muscles, TheVirialStressOfAnAffineBodyIsTheActiveStressAlongTheTurnedFiber) {
  std::mt19937 random(1);
  for (const Points& rest : {test::fcc_ball(6, r), test::hcp_ball(6, r)})
    for (const std::uint32_t i : {nearest_the_middle(rest), std::uint32_t{0}}) {
      Muscle muscle = everywhere(rest, 3 * aslant);
      muscle.weights = {{i, 1}};
      const Muscles muscles = make_muscles(rest, r, {muscle});
      const Mat3 F = Mat3::Identity() + 0.6 * test::random_matrix(random);
      const Points now = test::affine(rest, F, {1, 2, 3});
      const Vec3 t = (F * aslant).normalized();
      const Mat3 stress = Pulled(muscles, now, 0.7).virial(now) / volume_per_particle(r);
      EXPECT_LT((stress - 0.7 * S * t * t.transpose()).norm(), 1e-10 * S);
    }
}

TEST(Muscles, StressForOutputIsTheSame) {
  const Points rest = test::fcc_ball(5, r);
  const Muscles muscles = make_muscles(rest, r, {everywhere(rest, aslant)});
  const Mat3 F = test::turned({1, 1, 0}, 50) * Vec3(0.8, 1.1, 1.2).asDiagonal();
  const Vec3 t = (F * aslant).normalized();
  const auto stress = muscle_stress(muscles, {{0.5}, {0}}, test::affine(rest, F));
  for (const Mat3& one : stress) EXPECT_LT((one - 0.5 * S * t * t.transpose()).norm(), 1e-10 * S);
}

TEST(Muscles, InnerParticlesOfAnAffineBodyFeelNoForce) {
  const Points rest = test::fcc_ball(8, r);
  const Muscles muscles = make_muscles(rest, r, {everywhere(rest, aslant)});
  const Mat3 F = test::turned({1, 1, 0}, 50) * Vec3(0.8, 1.1, 1.2).asDiagonal();
  const Pulled pulled(muscles, test::affine(rest, F));
  double most = 0;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const bool inner = rest[i].norm() < 3.9 * r;
    EXPECT_LT(pulled.forces[i].norm(), (inner ? 1e-12 : 100) * S * r * r);
    most = std::max(most, pulled.forces[i].norm());
  }
  EXPECT_GT(most, 0.1 * S * r * r);
}

TEST(Muscles, MomentumAndAngularMomentumAreKept) {
  const Points rest = test::hcp_ball(6, r);
  Muscle soft = everywhere(rest, aslant);
  soft.weights = weights_in({SphereShape{{3 * r, 0, 0}, 2 * r}, 3 * r}, rest);
  const Muscles muscles = make_muscles(rest, r, {everywhere(rest, Vec3::UnitX()), soft});
  const Points now = shaken(test::affine(rest, test::turned({1, 2, 3}, 130)), 0.8 * r);
  const Pulled pulled(muscles, now);
  Vec3 moment = Vec3::Zero();
  double scale = 0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    moment += now[i].cross(pulled.forces[i]);
    scale += pulled.forces[i].norm();
  }
  ASSERT_GT(scale, S * r * r);
  EXPECT_LT(pulled.sum().norm(), 1e-14 * scale);
  EXPECT_LT(moment.norm(), 1e-14 * scale * 6 * r);
}

/// Forces are minus the slope of the energy, at a few particles.
void expect_gradient(const Muscles& muscles, Points now) {
  const Pulled here(muscles, now);
  const double h = 1e-7;
  for (std::size_t i = 0; i < now.size(); i += 9)
    for (int axis = 0; axis < 3; ++axis) {
      const double was = now[i][axis];
      now[i][axis] = was + h;
      const double up = Pulled(muscles, now).energy.stored;
      now[i][axis] = was - h;
      const double down = Pulled(muscles, now).energy.stored;
      now[i][axis] = was;
      EXPECT_NEAR(here.forces[i][axis], -(up - down) / (2 * h), 1e-6 * S * r * r);
    }
}

TEST(Muscles, ForcesAreMinusTheGradientOfThePotential) {
  const Points rest = test::fcc_ball(4.5, r);
  Muscle soft = everywhere(rest, Vec3::UnitY());
  soft.weights = weights_in({SphereShape{{0, 0, 0}, 2 * r}, 3 * r}, rest);
  const Muscles muscles = make_muscles(rest, r, {everywhere(rest, aslant), soft});
  expect_gradient(muscles, shaken(rest, 0.6 * r));
  // Crushed below half its length, flat, and turned inside out.
  for (const double length : {0.55, 0.45, 0.0, -0.6}) {
    const Mat3 F = Mat3::Identity() + (length - 1) * aslant * aslant.transpose();
    expect_gradient(muscles, shaken(test::affine(rest, F), 0.2 * r));
  }
}

TEST(Muscles, ThePowerOfActivationIsTheChangeOfEnergyAtFixedPositions) {
  const Points rest = test::fcc_ball(4.5, r), now = shaken(rest, 0.5 * r);
  const Muscles muscles = make_muscles(rest, r, {everywhere(rest, aslant)});
  const double h = 1e-3;
  const double slope =
      (Pulled(muscles, now, 0.4 + h).energy.stored - Pulled(muscles, now, 0.4 - h).energy.stored) /
      (2 * h);
  EXPECT_NEAR(Pulled(muscles, now, 0.4, 3).energy.power, 3 * slope, 1e-9 * std::abs(slope));
  EXPECT_EQ(Pulled(muscles, now, 0).energy.stored, 0);
  EXPECT_EQ(Pulled(muscles, rest).energy.power, 0);
}

/// A free bar along z, at rest under its muscle; the mean stretch of its middle.
Vec3 stretches_of_pulled_bar(int across, int along, double strength) {
  Settings scene = test::box_scene();
  scene.material.density = 1000;
  const Material material = test::material_of(scene);
  const Points rest = test::fcc_box(across, across, along, r);
  Muscle muscle = everywhere(rest, Vec3::UnitZ());
  muscle.strength = strength;
  const Muscles muscles = make_muscles(rest, r, {muscle});
  Particles bar = particles_at(rest, r, material.mass);
  const double rate = std::sqrt(material.stiffness() / material.mass), dt = 0.35 / rate;
  Forces forces;
  Points pulls;
  for (int step = 0; step < 600; ++step) {
    pair_forces(bar, material, forces);
    muscle_forces(muscles, {{1}, {0}}, bar, pulls);
    for (std::size_t i = 0; i < bar.size(); ++i) {
      const Vec3 a = (forces.pair[i] + pulls[i]) / material.mass - 0.3 * rate * bar.velocity(i);
      bar.set_velocity(i, bar.velocity(i) + dt * a);
      bar.set_position(i, bar.position(i) + dt * bar.velocity(i));
    }
  }
  EXPECT_LT(test::largest_speed(bar), 1e-6 * r * rate);
  const auto F = test::deformation_gradients(muscles.rest, positions_of(bar));
  const double middle = half_plane_spacing(r) * along / 2;
  Vec3 sum = Vec3::Zero();
  int count = 0;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    if (std::abs(rest[i].z() - middle) > middle / 3) continue;
    sum += F[i].diagonal();
    ++count;
  }
  return sum / count;
}

// A bar n half-planes wide has fewer bonds than the infinite packing: q = (n - 1) / n of those that
// climb, q^2 of those across. Its modulus is 3 q^2 / (1 + 2 q) of E[100] = 0.9428 k / d0, its
// ratio of Poisson 1 / (1 + 2 q).
TEST(Muscles, AFreeBarShortensByTheActiveStressOverItsModulus) {
  const Material material = test::material_of(test::box_scene());
  const int n = 7;
  const double q = (n - 1.0) / n;
  const double bulk = 2 * std::numbers::sqrt2 / 3 * material.stiffness() / nearest_distance(r);
  const double modulus = bulk * 3 * q * q / (1 + 2 * q), strength = 0.002 * bulk;
  const Vec3 stretch = stretches_of_pulled_bar(n, 17, strength);
  const double strain = stretch.z() - 1;
  EXPECT_NEAR(-strain * modulus / strength, 1, 0.03);
  EXPECT_NEAR(-(stretch.x() - 1) / strain, 1 / (1 + 2 * q), 0.02);
}

TEST(Muscles, ForcesFollowTheParticlesWhateverTheirOrder) {
  const Points rest = test::fcc_ball(5, r), now = shaken(rest, 0.4 * r);
  Muscle half = everywhere(rest, aslant);
  half.weights = weights_in({PlaneShape{}, r}, rest);
  const Muscles muscles = make_muscles(rest, r, {half});
  const Particles particles = particles_at(now, r, 1);
  std::vector<std::size_t> order(rest.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = order.size() - 1 - i;
  Points plain, turned;
  muscle_forces(muscles, {{1}, {0}}, particles, plain);
  muscle_forces(muscles, {{1}, {0}}, test::reordered(particles, order), turned);
  for (std::size_t i = 0; i < order.size(); ++i) EXPECT_EQ(turned[i], plain[order[i]]);
}

/// The largest eigenvalue of the Hessian of the energy at rest, by power iteration on differences.
double measured_stiffness(const Muscles& muscles, const Points& rest) {
  Points mode = shaken(Points(rest.size(), Vec3::Zero()), 1);
  double value = 0;
  for (int round = 0; round < 60; ++round) {
    double norm = 0;
    for (const Vec3& v : mode) norm += v.squaredNorm();
    Points up = rest, down = rest;
    const double h = 1e-5 * r / std::sqrt(norm);
    for (std::size_t i = 0; i < rest.size(); ++i) up[i] += h * mode[i], down[i] -= h * mode[i];
    const Pulled above(muscles, up), below(muscles, down);
    double product = 0;
    for (std::size_t i = 0; i < rest.size(); ++i) {
      const Vec3 image = (below.forces[i] - above.forces[i]) / (2 * h);
      product += image.dot(mode[i]);
      mode[i] = image;
    }
    value = product / norm;
  }
  return std::abs(value);
}

TEST(Muscles, TheirStiffnessAtRestIsBounded) {
  for (const Vec3& direction : {Vec3(0, 0, 1), Vec3(1, 1, 0), Vec3(1, 1, 1), aslant}) {
    const Points rest = test::fcc_ball(6, r);
    const Muscles muscles = make_muscles(rest, r, {everywhere(rest, direction)});
    const double bound = muscle_stiffness(muscles, r), measured = measured_stiffness(muscles, rest);
    EXPECT_LE(measured, bound);
    EXPECT_GT(measured, 0.1 * bound);  // the outermost particles set the bound
  }
}

TEST(Muscles, ParticlesWithoutAGradientHaveNoFibers) {
  const Points row = {{0, 0, 0}, {2 * r, 0, 0}, {4 * r, 0, 0}};
  const Muscles muscles = make_muscles(row, r, {everywhere(row, Vec3::UnitX())});
  EXPECT_TRUE(muscles.active.empty());
  const Pulled pulled(muscles, row);
  for (const Vec3& force : pulled.forces) EXPECT_EQ(force, Vec3(0, 0, 0));
  EXPECT_EQ(muscle_stiffness(muscles, r), 0);
}

TEST(Muscles, TheWeightsOfABoneAreThoseOfItsBinding) {
  Settings scene = test::box_scene();
  scene.binding.joint_zone = 1;
  const Body body = test::make_body(scene, test::fcc_box(11, 11, 49, r));
  const auto lower = weights_bound_to(0, body.binding), upper = weights_bound_to(1, body.binding);
  double sum = 0;
  for (const auto* weights : {&lower, &upper})
    for (const MuscleWeight& entry : *weights) sum += entry.weight;
  EXPECT_GT(lower.size() + upper.size(), body.rest.size());  // a zone belongs to both
  EXPECT_NEAR(sum, static_cast<double>(body.rest.size()), 1e-9);
  Muscle muscle = everywhere(body.rest, body.skeleton.bones[1].axis());
  muscle.weights = upper;
  EXPECT_NO_THROW(make_muscles(body.rest, r, {muscle}));
}

TEST(Muscles, BadOnesAreRefusedByName) {
  const Points rest = test::fcc_ball(3, r);
  const auto refused = [&](auto spoil, const std::string& why) {
    Muscle muscle = everywhere(rest, Vec3::UnitZ());
    spoil(muscle);
    test::expect_bad_input([&] { make_muscles(rest, r, {muscle}); }, {"'biceps'", why});
  };
  refused([](Muscle& m) { m.direction = Vec3::Zero(); }, "a direction without length");
  refused([](Muscle& m) { m.strength = NAN; }, "a strength of");
  refused([](Muscle& m) { m.weights.clear(); }, "has 0 particles");
  refused([](Muscle& m) { m.weights[0].weight = 1.5; }, "a share of 1.5");
  refused([](Muscle& m) { m.weights[1].particle = 0; }, "names particle 0");
  refused([](Muscle& m) { m.activation = {{0, 1}, {0, 2}}; }, "has the value 2");
  refused([](Muscle& m) { m.activation = {{1, 1}, {0, 1}}; }, "does not come later");
  refused([](Muscle& m) { m.activation = {{1}, {}}; }, "1 times and 0 values");
}

}  // namespace sinew::muscles_test

// SPDX-License-Identifier: GPL-3.0-or-later
// Weights of volumes: near a surface they make up for each other, so that a strained body has the
// energy of a continuum, and none takes more than the step allows.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <sinew/analysis/time_step.h>
#include <sinew/body/bond_factors.h>
#include <sinew/body/solid.h>
#include <sinew/body/volume_weights.h>

#include "support/world.h"

namespace sinew::volume_weights_test {

constexpr double r = 0.01;

Material material_of(double poisson_ratio) {
  MaterialOptions options;
  options.model = MaterialModel::bonded_volume;
  options.young_modulus = 1e5;
  options.poisson_ratio = poisson_ratio;
  return make_material(options, {r, 1000 * volume_per_particle(r)});
}

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

std::vector<std::int32_t> numbers(std::size_t particles) {
  std::vector<std::int32_t> ids(particles);
  std::iota(ids.begin(), ids.end(), 0);
  return ids;
}

TEST(VolumeWeights, SumToTheBody) {
  const Points rest = test::fcc_box(13, 13, 13, r);
  const auto particles = static_cast<double>(rest.size());
  EXPECT_LT(sum(own_volume_weights(rest, test::nearest(rest, r), r)), 0.72 * particles);
  EXPECT_NEAR(sum(volume_weights(rest, test::nearest(rest, r), material_of(0.4), {})), particles,
              0.025 * particles);
}

TEST(VolumeWeights, AreOneFarFromSurfacesAndNowhereMoreThanTheMost) {
  const Points rest = test::fcc_box(21, 21, 21, r);
  for (const double ratio : {0.3, 0.4, 0.45, 0.49}) {
    const Material material = material_of(ratio);
    const double most = max_volume_weight(material);
    EXPECT_GT(most, 1.1);
    EXPECT_LE(most, 2);
    const std::vector<double> weights = volume_weights(rest, test::nearest(rest, r), material, {});
    EXPECT_DOUBLE_EQ(*std::max_element(weights.begin(), weights.end()), most);
    const Vec3 middle(0, 0, 10.5 * half_plane_spacing(r));
    for (std::size_t i = 0; i < rest.size(); ++i)
      if ((rest[i] - middle).norm() < 1.5 * r) {
        EXPECT_NEAR(weights[i], 1, 1e-12);
      }
  }
}

TEST(VolumeWeights, FollowVolumeShares) {
  const Points rest = test::fcc_box(13, 13, 13, r);
  const Material material = material_of(0.4);
  std::vector<double> volume_share(rest.size(), 1);
  for (std::size_t i = 0; i < rest.size(); ++i)
    if (rest[i].z() < half_plane_spacing(r)) volume_share[i] = 0.5;
  const std::vector<double> less =
      volume_weights(rest, test::nearest(rest, r), material, volume_share);
  EXPECT_LT(sum(less), sum(volume_share) * (1 + 1e-12));
  EXPECT_GT(sum(less), 0.97 * sum(volume_share));
}

/// Returns the energy of a body of 13 planes over that of an isotropic continuum of its size.
double energy_ratio(double ratio, const Mat3& strain, const BondFactors& factors,
                    const Material& material, const Points& rest) {
  Solid solid(material, rest, numbers(rest.size()), factors);
  const Points now = test::affine(rest, Mat3::Identity() + strain);
  Particles particles = particles_at(now, r, material.mass);
  const double E = 1e5, G = E / (2 * (1 + ratio)), lame = 2 * G * ratio / (1 - 2 * ratio);
  const double density = lame / 2 * strain.trace() * strain.trace() + G * strain.squaredNorm();
  return solid.energy(particles) /
         (density * static_cast<double>(rest.size()) * volume_per_particle(r));
}

TEST(VolumeWeights, GiveAStrainedBodyTheEnergyOfAContinuum) {
  const Points rest = test::fcc_box(13, 13, 13, r);
  Mat3 pulled = Mat3::Zero();
  pulled.diagonal() = 1e-6 * Vec3(1, -0.2, 0.3);
  for (const double ratio : {0.3, 0.4}) {
    const Material material = material_of(ratio);
    BondFactors factors = bond_factors(rest, test::neighbors(rest, material), material, {});
    EXPECT_NEAR(energy_ratio(ratio, pulled, factors, material, rest), 1, 0.02);
    factors.volume_weight = own_volume_weights(rest, test::nearest(rest, r), r);
    EXPECT_LT(energy_ratio(ratio, pulled, factors, material, rest), 0.96);
  }
}

TEST(VolumeWeights, KeepTheStepLimitOfTheBody) {
  for (const double ratio : {0.4, 0.45, 0.49})
    for (const double angle : {0.0, 35.0}) {
      Points rest;
      for (const Vec3& place : test::fcc_ball(15, r)) {
        const Vec3 turned = test::turned({1, 2, 3}, angle) * place;
        if (turned.cwiseAbs().maxCoeff() < 6.5 * r) rest.push_back(place);
      }
      Body body;
      body.rest = rest;
      body.material = material_of(ratio);
      body.material.damping = 0;
      body.binding.first.assign(rest.size() + 1, 0);
      body.factors = bond_factors(rest, *neighbors_of(body), body.material, {});
      const double limit = step_limit(Integrator::symplectic_euler, body);
      EXPECT_LT(limit, power_step_limit(body) / 0.99 * 1.002) << ratio << ' ' << angle;
      EXPECT_GT(limit, 0.85 * power_step_limit(body));
    }
}

}  // namespace sinew::volume_weights_test

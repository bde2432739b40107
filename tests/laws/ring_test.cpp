// SPDX-License-Identifier: GPL-3.0-or-later
// A free body that is bent and let go rings at the frequency and with the damping ratio that
// elastic_modes() tells, whatever its shape, its material and its form of damping.
#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <complex>

#include <gtest/gtest.h>

#include <sinew/analysis/elastic_modes.h>
#include <sinew/scene/prepare.h>

#include "support/world.h"

namespace sinew::ring_test {

constexpr double r = 0.01;
constexpr int samples_per_period = 16;

Points bar() { return test::fcc_box(5, 5, 31, r); }

/// A bar with an arm and a foot.
Points crooked() {
  Points all;
  for (const Vec3& place : test::fcc_box(21, 5, 31, r)) {
    const double s = half_plane_spacing(r), x = place.x() / s, z = place.z() / s;
    const bool trunk = x<-8, arm = z> 36, foot = z < 6 && x < 3;
    if (trunk || arm || foot) all.push_back(place);
  }
  return all;
}

/// A plate with round corners.
Points plate() {
  Points all;
  for (const Vec3& place : test::fcc_box(19, 19, 3, r))
    if (std::hypot(place.x(), place.y()) < 11.5 * half_plane_spacing(r)) all.push_back(place);
  return all;
}

/// A smooth displacement without a rigid part, of about `size` (m).
Points bent(const Points& rest, double size) {
  Vec3 center = Vec3::Zero();
  Box box;
  for (const Vec3& place : rest)
    center += place / static_cast<double>(rest.size()), box.extend(place);
  const double half = box.sizes().maxCoeff() / 2;
  Eigen::MatrixXd rigid(3 * rest.size(), 6);
  Eigen::VectorXd u(3 * rest.size());
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const Vec3 x = (rest[i] - center) / half;
    u.segment<3>(3 * i) = Vec3(x.z() * x.z(), 0.3 * x.y() * x.z(),
                               x.x() * (x.x() + x.y() - 2 * x.z()) - 0.7 * x.y() * x.y());
    for (int axis = 0; axis < 3; ++axis) {
      rigid.block<3, 1>(3 * i, axis) = Vec3::Unit(axis);
      rigid.block<3, 1>(3 * i, 3 + axis) = Vec3::Unit(axis).cross(x);
    }
  }
  u -= rigid * rigid.colPivHouseholderQr().solve(u);
  u *= size / u.cwiseAbs().maxCoeff();
  Points all(rest.size());
  for (std::size_t i = 0; i < rest.size(); ++i) all[i] = u.segment<3>(3 * i);
  return all;
}

/// The slowest oscillation that is seen in equidistant samples: of the exponentials that fit them
/// (Prony's method) and have some amplitude in them.
std::complex<double> slowest(const std::vector<double>& samples, int exponentials,
                             double interval) {
  const auto count = static_cast<Eigen::Index>(samples.size()), rows = count - exponentials;
  Eigen::MatrixXd before(rows, exponentials);
  Eigen::VectorXd after(rows);
  for (Eigen::Index n = 0; n < rows; ++n) {
    for (int k = 0; k < exponentials; ++k)
      before(n, k) = samples[static_cast<std::size_t>(n + exponentials - 1 - k)];
    after[n] = samples[static_cast<std::size_t>(n + exponentials)];
  }
  const Eigen::VectorXd of =
      before.jacobiSvd(Eigen::ComputeThinU | Eigen::ComputeThinV).solve(after);
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(exponentials, exponentials);
  companion.row(0) = of.transpose();
  companion.bottomLeftCorner(exponentials - 1, exponentials - 1).setIdentity();
  const Eigen::VectorXcd values = companion.eigenvalues();
  Eigen::MatrixXcd powers(count, exponentials);
  Eigen::VectorXcd seen(count);
  for (Eigen::Index n = 0; n < count; ++n) {
    seen[n] = samples[static_cast<std::size_t>(n)];
    for (Eigen::Index k = 0; k < exponentials; ++k)
      powers(n, k) = std::pow(values[k], static_cast<double>(n));
  }
  const Eigen::VectorXcd amplitude = powers.colPivHouseholderQr().solve(seen);
  const double most = amplitude.cwiseAbs().maxCoeff();
  std::complex<double> found(0, 1e300);
  for (Eigen::Index k = 0; k < exponentials; ++k) {
    const std::complex<double> rate = std::log(values[k]) / interval;
    if (std::abs(amplitude[k]) > 0.1 * most && rate.imag() > 0.02 / interval &&
        std::abs(rate) < std::abs(found))
      found = rate;
  }
  return found;
}

struct Ring {
  double frequency, ratio;
};

Ring measured(const Settings& settings, const Points& rest, double frequency) {
  const Body body = test::make_body(settings, rest);
  Particles particles = test::particles_of(settings, rest);
  const Points shape = bent(rest, 0.02 * r);
  for (std::size_t i = 0; i < rest.size(); ++i) particles.set_position(i, rest[i] + shape[i]);
  const double interval = 2 * pi / frequency / samples_per_period;
  const double limit = 0.8 * step_limit(settings.solver.integrator, body);
  const int steps = static_cast<int>(std::ceil(interval / limit));
  Simulation simulation = test::simulation_from(settings, rest, particles, interval / steps);
  // Late enough for the faster modes to be gone, early enough to see what rings.
  const int waited = samples_per_period / 2, sampled = 3 * samples_per_period;
  std::vector<double> samples;
  for (int n = 0; n < waited + sampled; ++n) {
    for (int step = 0; step < steps; ++step) simulation.step();
    const Particles& now = simulation.particles();
    double projected = 0;
    for (std::size_t i = 0; i < now.size(); ++i) {
      const auto id = static_cast<std::size_t>(now.id[i]);
      projected += shape[id].dot(now.position(i) - rest[id]);
    }
    if (n >= waited) samples.push_back(projected / (r * r));
  }
  const std::complex<double> rate = slowest(samples, 12, interval);
  return {std::abs(rate), -rate.real() / std::abs(rate)};
}

struct Rung {
  const char* name;
  Points (*rest)();
  MaterialModel model;
  double max_central = 0.5;  ///< a larger ratio of that form takes too many steps for a test
};

class DampingRatio : public testing::TestWithParam<Rung> {};

TEST_P(DampingRatio, IsThatOfABodyThatRings) {
  const Points rest = GetParam().rest();
  for (const auto form : {DampingForm::paper, DampingForm::symmetric, DampingForm::central})
    for (const double ratio : {0.02, 0.1, 0.5}) {
      if (form == DampingForm::central && ratio > GetParam().max_central) continue;
      Settings settings = test::unbound(test::box_scene(25));
      settings.material.model = GetParam().model;
      settings.material.damping_form = form;
      settings.material.damping_ratio = ratio;
      const Body body = test::make_body(settings, rest);
      const ElasticModes modes = elastic_modes(body);
      const Ring ring = measured(settings, rest, modes.frequency());
      EXPECT_NEAR(ring.ratio, ratio, 0.1 * ratio)
          << GetParam().name << ", form " << static_cast<int>(form);
      EXPECT_NEAR(ring.frequency, modes.frequency(), (ratio < 0.3 ? 0.03 : 0.1) * ring.frequency);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Of, DampingRatio,
    testing::Values(Rung{"PaperBar", bar, MaterialModel::paper},
                    Rung{"BondedBar", bar, MaterialModel::bonded},
                    Rung{"BondedVolumeBar", bar, MaterialModel::bonded_volume, 0.02},
                    Rung{"BondedCrooked", crooked, MaterialModel::bonded, 0.02},
                    // (Two modes of a bonded plate are too near each other to be told apart.)
                    Rung{"PaperPlate", plate, MaterialModel::paper, 0.1}),
    [](const auto& rung) { return std::string(rung.param.name); });

TEST(Presets, SwingAsTheirDampingRatioSays) {
  const Points rest = test::fcc_box(5, 5, 25, r);
  for (const MaterialPreset& preset : material_presets())
    for (const auto model : {MaterialModel::paper, MaterialModel::bonded}) {
      if (preset.yield_strain && model == MaterialModel::paper) continue;
      Settings settings = test::unbound(test::box_scene(25));
      settings.material.model = model;
      settings.material.density = preset.density;
      settings.material.young_modulus = preset.young_modulus;
      settings.material.damping_ratio = preset.damping_ratio;
      settings.material.yield_strain = preset.yield_strain;
      const ElasticModes modes = elastic_modes(test::make_body(settings, rest));
      const Ring ring = measured(settings, rest, modes.frequency());
      EXPECT_NEAR(ring.ratio, preset.damping_ratio, 0.1 * preset.damping_ratio) << preset.what;
    }
}

/// Bar that is too large to be solved exactly.
TEST(DampingRatioOfALargerBody, IsThatOfABodyThatRings) {
  for (const auto model : {MaterialModel::paper, MaterialModel::bonded}) {
    Settings settings = test::unbound(test::box_scene(25));
    settings.material.model = model;
    settings.material.damping_ratio = 0.1;
    const Points rest = test::fcc_box(13, 13, 61, r);
    const ElasticModes modes = elastic_modes(test::make_body(settings, rest));
    const Ring ring = measured(settings, rest, modes.frequency());
    EXPECT_NEAR(ring.ratio, 0.1, 0.01);
    EXPECT_NEAR(ring.frequency, modes.frequency(), 0.03 * ring.frequency);
  }
}

/// Too thin to be coarsened: of two of its seven layers nothing is left that bends as it does.
TEST(DampingRatioOfALargeThinBody, IsThatOfABodyThatRings) {
  Settings settings = test::unbound(test::box_scene(25));
  settings.material.model = MaterialModel::bonded;
  settings.material.damping_form = DampingForm::paper;
  settings.material.damping_ratio = 0.1;
  const Points rest = test::fcc_box(7, 25, 101, r);
  ASSERT_GT(rest.size(), 8000u);
  const ElasticModes modes = elastic_modes(test::make_body(settings, rest));
  ASSERT_FALSE(modes.empty());
  const Ring ring = measured(settings, rest, modes.frequency());
  EXPECT_NEAR(ring.ratio, 0.1, 0.01);
  EXPECT_NEAR(ring.frequency, modes.frequency(), 0.03 * ring.frequency);
}

TEST(LayersAcross, AreThoseOfTheThinnestPart) {
  const auto layers = [](const Points& rest) {
    return layers_across(test::make_body(test::unbound(test::box_scene(25)), rest));
  };
  EXPECT_EQ(layers(test::fcc_box(7, 41, 41, r)), 7);
  EXPECT_EQ(layers(test::fcc_box(9, 9, 61, r)), 9);
  EXPECT_EQ(layers(test::fcc_box(15, 15, 15, r)), 15);
  Points loose = test::fcc_box(7, 41, 41, r);
  for (std::size_t i = 0; i < loose.size(); ++i) loose[i] *= 1 + 1e-3 * static_cast<double>(i % 7);
  EXPECT_TRUE(std::isinf(layers(loose)));
  Points dumbbell = test::fcc_box(5, 5, 61, r);  // between thick ends
  for (const Vec3& place : test::fcc_box(17, 17, 13, r)) {
    const Vec3 shifted = place - Vec3(6, 7, 13) * std::sqrt(2.0) * r;
    dumbbell.push_back(shifted);
  }
  const double found = layers(dumbbell);
  EXPECT_GE(found, 5);
  EXPECT_LE(found, 7);
}

/// Still larger ones ring as a coarser packing of them does, nearly.
TEST(CoarseBody, RingsNearlyAsTheBodyItself) {
  for (const int planes : {17, 19})
    for (const auto model : {MaterialModel::paper, MaterialModel::bonded}) {
      Settings settings = test::unbound(test::box_scene(25));
      settings.material.model = model;
      const Body body = test::make_body(settings, test::fcc_box(9, planes, 2 * planes + 1, r));
      const Body coarse = coarse_body(body, 2);
      EXPECT_LT(coarse.rest.size(), body.rest.size() / 5);
      EXPECT_NEAR(coarse.material.mass * static_cast<double>(coarse.rest.size()),
                  body.material.mass * static_cast<double>(body.rest.size()), 1e-9);
      const double own = elastic_modes(body).frequency();
      EXPECT_NEAR(elastic_modes(coarse).frequency(), own, 0.35 * own);
    }
}

}  // namespace sinew::ring_test

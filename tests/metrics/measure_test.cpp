// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/frame_metrics.h>

#include <gtest/gtest.h>

#include <bit>

#include <sinew/core/error.h>
#include <sinew/core/parallel.h>
#include <sinew/metrics/table.h>
#include "metrics/world.h"
#include "support/expect_error.h"

namespace sinew::test::measure_test {

constexpr double exact = 1e-12;

/// A crooked but smooth deformation, different everywhere.
Vec3 crooked(const Vec3& p) {
  return p + 0.3 * r * Vec3(std::sin(40 * p.z()), std::cos(55 * p.x()), std::sin(70 * p.y()));
}

void expect_same_bits(const FrameMetrics& one, const FrameMetrics& other) {
  for (const Metric& metric : metrics_table())
    EXPECT_EQ(std::bit_cast<std::uint64_t>(one.*metric.value),
              std::bit_cast<std::uint64_t>(other.*metric.value))
        << metric.name;
}

TEST(Measure, BodyAtRestHasNoErrors) {
  const RestBody body = rest_body(box_input());
  const FrameMetrics m = measure(body, at_rest(body));
  EXPECT_NEAR(m.volume, std::pow(across * h, 2) * along * h, exact);
  EXPECT_NEAR(m.J_min, 1, exact);
  EXPECT_NEAR(m.J_mean, 1, exact);
  for (const double zero : {m.bone_angle, m.bone_shift, m.volume_error, m.displacement_max,
                            m.displacement_rms, m.speed_max, m.adherence_max, m.pose_error_max,
                            m.broken_neighbors, m.new_neighbors, m.inverted, m.energy_residual})
    EXPECT_NEAR(zero, 0, exact);
  EXPECT_NEAR(m.tip_angle, 0, 1e-6);
  EXPECT_NEAR(m.twist_jump_max, 0, 1e-6);
}

TEST(Measure, RigidMotionOfBodyAndBonesStrainsNothing) {
  const RestBody body = rest_body(box_input());
  const FrameMetrics m =
      measure(body, moved_rigidly(body, turned(73, {1, 2, 3}), {0.3, -0.2, 0.1}));
  EXPECT_NEAR(m.bone_angle, 73, 1e-9);
  EXPECT_NEAR(m.volume_error, 0, exact);
  EXPECT_NEAR(m.J_min, 1, exact);
  EXPECT_NEAR(m.J_mean, 1, exact);
  for (const double zero : {m.adherence_max, m.pose_error_max, m.pose_error_far_rms,
                            m.broken_neighbors, m.new_neighbors, m.inverted})
    EXPECT_NEAR(zero, 0, exact);
  EXPECT_NEAR(m.tip_angle, 73, 1e-9);
  EXPECT_NEAR(m.twist_jump_max, 0, 1e-6);
}

TEST(Measure, TranslationIsTheDisplacementOfEveryParticleAndTheShiftOfTheBones) {
  const RestBody body = rest_body(box_input());
  const FrameMetrics m = measure(body, moved_rigidly(body, Mat3::Identity(), {0.3, 0.4, 1.2}));
  EXPECT_NEAR(m.displacement_max, 1.3, exact);
  EXPECT_NEAR(m.displacement_rms, 1.3, exact);
  EXPECT_NEAR(m.bone_shift, 1.3, exact);
  EXPECT_NEAR(m.bone_angle, 0, exact);
}

TEST(Measure, AffineMotionScalesVolumeAndEveryJByItsDeterminant) {
  const RestBody body = rest_body(box_input());
  const Mat3 A = (Mat3() << 1.1, 0.2, -0.1, 0.05, 0.9, 0.3, -0.2, 0.1, 1.2).finished();
  const FrameMetrics m = measure(body, moved(body, [&](const Vec3& p) -> Vec3 { return A * p; }));
  const double J = A.determinant();
  EXPECT_NEAR(m.volume_ratio, J, exact);
  EXPECT_NEAR(m.volume_error, std::abs(J - 1), exact);
  EXPECT_NEAR(m.J_min, J, exact);
  EXPECT_NEAR(m.J_mean, J, exact);
}

TEST(Measure, StretchDisplacesByTheStrainTimesTheHeight) {
  const RestBody body = rest_body(box_input());
  const double strain = 0.04;
  const FrameMetrics m = measure(
      body, moved(body, [&](const Vec3& p) { return Vec3(p.x(), p.y(), (1 + strain) * p.z()); }));
  double squares = 0;
  for (const Vec3& p : body.shape.points) squares += p.z() * p.z();
  EXPECT_NEAR(m.displacement_max, strain * (along - 0.5) * h, exact);
  EXPECT_NEAR(m.displacement_rms,
              strain * std::sqrt(squares / static_cast<double>(body.particles())), exact);
}

TEST(Measure, SpeedIsThatOfTheFastestParticle) {
  const RestBody body = rest_body(box_input());
  FrameState state = at_rest(body);
  state.velocities[3] = {0, 3, 4};
  state.velocities[7] = {4.9, 0, 0};
  EXPECT_NEAR(measure(body, state).speed_max, 5, exact);
}

TEST(Measure, NamesTheParticleThatHasTheWorstValue) {
  const RestBody body = rest_body(box_input());
  FrameState state = at_rest(body);
  state.velocities[7] = {0, 3, 4};
  const std::vector<MeasuredFrame> frames{measure_frame(body, at_rest(body)),
                                          measure_frame(body, state)};
  Summary summary = summarize(std::vector{frames[0].metrics, frames[1].metrics}, r);
  add_worst_particles(summary, std::vector{frames[0].worst_particles, frames[1].worst_particles});
  EXPECT_EQ(summary.metrics[metric_index("speed_max")].worst_particle, 7u);
  EXPECT_FALSE(summary.metrics[metric_index("volume")].worst_particle);
}

TEST(Measure, EnergiesPassThroughAndTheResidualClosesTheirBalance) {
  RestInput input = box_input();
  input.start = {1, -20, 3, 4, 5, 6};
  const RestBody body = rest_body(input);
  FrameState state = at_rest(body);
  state.energies = {1.5, -18, 3.25, 4, 9, 7, 0.5, 2};
  const FrameMetrics m = measure(body, state);
  EXPECT_EQ(m.kinetic_energy, 1.5);
  EXPECT_EQ(m.pair_energy, -18);
  EXPECT_EQ(m.bone_energy, 3.25);
  EXPECT_EQ(m.gravity_energy, 4);
  EXPECT_EQ(m.work_of_bones, 9);
  EXPECT_EQ(m.dissipation, 7);
  EXPECT_EQ(m.contact_energy, 0.5);
  EXPECT_EQ(m.work_of_world, 2);
  // stored grew by 0.5 + 2 + 0.25 + 0.5, bones gave 4 and the world 2, damping took 1
  EXPECT_NEAR(m.energy_residual, 3.25 - 4 - 2 + 1, exact);
}

TEST(Measure, AStretchIsEveryPercentileOfItsStrainAndScalesTheParticlesVolume) {
  const RestBody body = rest_body(box_input());
  const Mat3 F = Vec3(1, 1, 1.3).asDiagonal();
  const FrameMetrics m = measure(body, moved(body, [&](const Vec3& p) -> Vec3 { return F * p; }));
  const double strain = 2.0 / 3 * std::log(1.3);  // of ln(1.3) along one axis, its deviator
  for (const double value : {m.strain_50, m.strain_95, m.strain_99})
    EXPECT_NEAR(value, strain, exact);
  EXPECT_NEAR(m.stretch_max, 1.3, exact);
  EXPECT_NEAR(m.D2min_95, 0, exact);
  const double V0 = volume_per_particle(r);
  EXPECT_NEAR(m.particle_volume, 1.3 * V0 * static_cast<double>(body.particles()), exact);
  EXPECT_TRUE(std::isnan(m.von_mises_95));  // no pair force was given
}

TEST(Measure, RigidMotionKeepsStrainsAndTheSkin) {
  const RestBody body = rest_body(box_input());
  const FrameMetrics m = measure(body, moved_rigidly(body, turned(73, {1, 2, 3}), {0.3, 0, 0.1}));
  for (const double zero : {m.strain_50, m.strain_99, m.D2min_95, m.flipped_faces})
    EXPECT_NEAR(zero, 0, exact);
  for (const double one : {m.stretch_max, m.area_ratio, m.edge_stretch_max, m.area_stretch_max,
                           m.conformal_max, m.symmetric_dirichlet / 4})
    EXPECT_NEAR(one, 1, exact);
}

int half_planes_from_the_surface(const Vec3& p) {
  const double side = across * h / 2;
  return static_cast<int>(
      std::min({side - std::abs(p.x()), side - std::abs(p.y()), p.z(), along * h - p.z()}) / h);
}

TEST(Measure, TheFirstTwoHalfPlanesAreTheLayersOfABox) {
  const RestBody body = rest_body(box_input());
  for (std::size_t i = 0; i < body.particles(); ++i) {
    const int depth = half_planes_from_the_surface(body.shape.points[i]);
    EXPECT_EQ(body.layer[i], depth < 2 ? depth + 1 : 0);
  }
}

/// A face that is pushed: its two layers do not count, wherever else the largest stress is.
TEST(Measure, TheLargestStressIsNotThatOfLoadedLayers) {
  const RestBody body = rest_body(box_input());
  FrameState state = at_rest(body);
  state.von_mises.assign(body.particles(), 1);
  state.world_force.assign(body.particles(), Vec3::Zero());
  double left_out = 0;
  for (std::size_t i = 0; i < body.particles(); ++i) {
    const double below = along * h - body.shape.points[i].z();
    if (below < h) state.world_force[i] = {0, 0, -2};
    if (below < 2 * h) state.von_mises[i] = 9, ++left_out;
    if (below > 2 * h && below < 3 * h) state.von_mises[i] = 5;
  }
  const FrameMetrics pushed = measure(body, state);
  EXPECT_EQ(pushed.von_mises_max, 5);
  EXPECT_EQ(pushed.von_mises_left_out, left_out);
  state.world_force.clear();
  const FrameMetrics free = measure(body, state);
  EXPECT_EQ(free.von_mises_max, 9);
  EXPECT_EQ(free.von_mises_left_out, 0);
  state.world_force.assign(body.particles(), Vec3(0, 0, -2));
  state.von_mises.assign(body.particles(), not_measured);
  for (std::size_t i = 0; i < body.particles(); ++i)
    if (body.layer[i] > 0) state.von_mises[i] = 7;
  const FrameMetrics everywhere = measure(body, state);
  EXPECT_EQ(everywhere.von_mises_max, 7);
  EXPECT_EQ(everywhere.von_mises_left_out, 0);
}

TEST(Measure, ASpinningBodyHasTheMomentaOfARigidOne) {
  RestInput input = box_input();
  input.material.mass = 0.25;
  const RestBody body = rest_body(input);
  FrameState state = at_rest(body);
  const Vec3 drift(1, -2, 3), spin(0.5, 0.25, -1);
  Vec3 center = Vec3::Zero(), turning = Vec3::Zero();
  for (const Vec3& p : state.positions) center += p / static_cast<double>(body.particles());
  for (std::size_t i = 0; i < body.particles(); ++i) {
    const Vec3 arm = state.positions[i] - center;
    state.velocities[i] = drift + spin.cross(arm);
    turning += 0.25 * arm.cross(spin.cross(arm));
  }
  const double mass = 0.25 * static_cast<double>(body.particles());
  const Vec3 angular = turning + mass * center.cross(drift);
  const FrameMetrics m = measure(body, state);
  EXPECT_NEAR((Vec3(m.center_x, m.center_y, m.center_z) - center).norm(), 0, exact);
  EXPECT_NEAR((Vec3(m.momentum_x, m.momentum_y, m.momentum_z) - mass * drift).norm(), 0, 1e-10);
  EXPECT_NEAR(
      (Vec3(m.angular_momentum_x, m.angular_momentum_y, m.angular_momentum_z) - angular).norm(), 0,
      1e-10);
}

/// Bent, twisted and stretched, on its way.
FrameState deformed(const RestBody& body, const Vec3& at) {
  FrameState state = moved(body, [&](const Vec3& point) -> Vec3 {
    const Vec3 p = point - at;
    const Vec3 twisted_p = turned(300 * p.z(), {0.3, 0, 1}) * Vec3(1.1 * p.x(), p.y(), 1.2 * p.z());
    return twisted_p + Vec3(0.01, 0.02, 0.03) + at;
  });
  for (std::size_t i = 0; i < body.particles(); ++i) {
    const Vec3 arm = state.positions[i] - at;
    state.velocities[i] = Vec3(1, -2, 3) + Vec3(5, 2.5, -10).cross(arm) + 40 * arm.x() * arm;
  }
  state.bones[1].rotation = turned(30, {1, 2, 3}) * state.bones[1].rotation;
  state.bones[1].origin += Vec3(0.01, 0.02, 0.03);
  return state;
}

TEST(Measure, ABodyFarAwayHasTheMetricsOfOneAtTheOrigin) {
  const RestBody near = rest_body(box_input());
  const FrameMetrics expected = measure(near, deformed(near, Vec3::Zero()));
  for (const auto& [power, tolerance] : {std::pair(10, 1e-6), {17, 1e-5}, {23, 1e-3}}) {
    const Vec3 at(std::ldexp(0.25, power), 0, 0);
    const RestBody far = rest_body(moved_to(at, box_input()));
    FrameMetrics found = measure(far, deformed(far, at));
    found.center_x -= at.x();
    for (const Metric& metric : metrics_table()) {
      const double value = expected.*metric.value, other = found.*metric.value;
      ASSERT_EQ(std::isnan(value), std::isnan(other)) << metric.name;
      if (std::isnan(value)) continue;
      EXPECT_NEAR(other, value, tolerance * std::max(1e-3, std::abs(value))) << metric.name;
    }
  }
}

TEST(Measure, PullingTheHalvesApartBreaksTheCrossingPairs) {
  const RestBody body = rest_body(box_input());
  const FrameMetrics m = measure(body, moved(body, [](const Vec3& p) -> Vec3 {
                                   return p.z() > half_length ? Vec3(p + b * Vec3::UnitZ()) : p;
                                 }));
  // Between two half-planes every edge of the square grid of sites joins two particles.
  const double crossing = 2 * across * (across - 1);
  EXPECT_EQ(m.broken_neighbors, crossing / body.rest_pairs());
  EXPECT_EQ(m.new_neighbors, 0);
}

TEST(Measure, PairsAreBrokenFromTheInteractionRangeOn) {
  RestInput input = box_input();
  input.positions = {{0, 0, h}, {2 * r, 0, h}};
  input.bone = {0, 0};
  const RestBody body = rest_body(input);
  const auto broken_at = [&](double distance) {
    FrameState state = at_rest(body);
    state.positions[0].x() = 0;
    state.positions[1].x() = distance;
    return measure(body, state).broken_neighbors;
  };
  EXPECT_EQ(broken_at(std::nextafter(b, 0.0)), 0);
  EXPECT_EQ(broken_at(b), 1);
}

TEST(Measure, BrokenBondsAreAFractionOfThoseAtRest) {
  RestInput input = box_input();
  input.positions = {{0, 0, h}, {2 * r, 0, h}, {4 * r, 0, h}};
  input.bone = {0, 0, 0};
  const RestBody body = rest_body(input);
  FrameState state = at_rest(body);
  EXPECT_TRUE(std::isnan(measure(body, state).broken_bonds));  // of a body without bonds
  state.broken_bonds = {0, 1, 1};
  EXPECT_EQ(measure(body, state).broken_bonds, 0.5);
  for (const std::vector<std::int32_t>& impossible :
       {std::vector{0, 1}, std::vector{2, 1, 1}, std::vector{0, -1, 1}}) {
    state.broken_bonds = impossible;
    expect_bad_input([&] { measure(body, state); }, {"broken bonds"});
  }
}

TEST(Measure, NewNeighborsAreThoseThatWereNoneAtRest) {
  RestInput input = box_input();
  input.positions = {{0, 0, h}, {2 * r, 0, h}, {6 * r, 0, h}, {8 * r, 0, h}};
  input.bone = {0, 0, 0, 0};
  const RestBody body = rest_body(input);
  FrameState state = at_rest(body);
  for (const int i : {2, 3}) state.positions[i].x() -= 2 * r;  // 1 and 2 touch: one new pair
  const FrameMetrics m = measure(body, state);
  EXPECT_EQ(m.new_neighbors, 0.5);
  EXPECT_EQ(m.broken_neighbors, 0);
}

TEST(Measure, FoldInvertsTheParticlesBeyondIt) {
  const RestBody body = rest_body(box_input());
  const int last = 11;  // the fold runs between this plane and the next
  const double at = (last + 1) * h;
  const FrameMetrics m = measure(body, moved(body, [&](const Vec3& p) {
                                   return Vec3(p.x(), p.y(), p.z() > at ? 2 * at - p.z() : p.z());
                                 }));
  const auto beyond = std::count_if(body.shape.points.begin(), body.shape.points.end(),
                                    [&](const Vec3& p) { return plane_of(p) > last; });
  EXPECT_EQ(m.inverted, static_cast<double>(beyond));
  EXPECT_NEAR(m.J_min, -1, exact);
}

TEST(Measure, WhatCannotBeMeasuredIsNotANumber) {
  RestInput input = box_input();
  input.positions = {{0, 0, h}};  // no neighbors
  input.bone = {-1};
  input.skeleton.bones.clear();
  const RestBody body = rest_body(input);
  const FrameMetrics m = measure(body, at_rest(body));
  for (const double value :
       {m.bone_angle, m.adherence_rms, m.pose_error_rms, m.pose_error_far_rms, m.J_min, m.inverted,
        m.broken_neighbors, m.new_neighbors, m.tip_angle, m.twist_jump_max})
    EXPECT_TRUE(std::isnan(value));
  EXPECT_EQ(m.displacement_rms, 0);
}

TEST(Measure, FramesAreMeasuredInAnyOrder) {
  const RestBody body = rest_body(box_input());
  const FrameState one = moved(body, crooked), other = moved_rigidly(body, upright(), {1, 2, 3});
  const FrameMetrics first = measure(body, one);
  measure(body, other);
  expect_same_bits(first, measure(body, one));
}

TEST(Measure, IsTheSameForAnyNumberOfThreads) {
  RestInput input = box_input();
  input.positions = fcc_box(11, 49);  // several pieces of the parallel loops
  input.bone.clear();
  for (const Vec3& point : input.positions) input.bone.push_back(point.z() > half_length);
  const RestBody body = rest_body(input);
  const FrameState state = moved(body, crooked);
  const FrameMetrics expected = measure(body, state);
  for (const int threads : {1, 2, 3, 8})
    with_threads(threads, [&] { expect_same_bits(expected, measure(body, state)); });
}

TEST(Measure, RefusesAFrameOfAnotherBodyOrWithoutNumbers) {
  const RestBody body = rest_body(box_input());
  const auto refuses = [&](const std::function<void(FrameState&)>& spoil) {
    FrameState state = at_rest(body);
    spoil(state);
    EXPECT_THROW(measure(body, state), Error);
  };
  refuses([](FrameState& state) { state.positions.pop_back(); });
  refuses([](FrameState& state) { state.velocities.emplace_back(); });
  refuses([](FrameState& state) { state.surface_points.pop_back(); });
  refuses([](FrameState& state) { state.bones.pop_back(); });
  refuses([](FrameState& state) { state.positions[0].x() = not_measured; });
  refuses([](FrameState& state) { state.surface_points[2].y() = INFINITY; });
  refuses([](FrameState& state) { state.bones[1].rotation(1, 2) = not_measured; });
}

TEST(RestBody, RefusesInputThatDoesNotFitTogether) {
  const auto refuses = [&](const std::function<void(RestInput&)>& spoil) {
    RestInput input = box_input();
    spoil(input);
    EXPECT_THROW(rest_body(input), Error);
  };
  refuses([](RestInput& input) { input.positions.clear(), input.bone.clear(); });
  refuses([](RestInput& input) { input.bone.pop_back(); });
  refuses([](RestInput& input) { input.bone[0] = 2; });
  refuses([](RestInput& input) { input.bone[0] = -2; });
  refuses([](RestInput& input) { input.skeleton.bones[1].parent = 1; });
  refuses([](RestInput& input) { input.skeleton.bones[0].length = 0; });
  refuses([](RestInput& input) { input.material.pair.r = 0; });
  refuses([](RestInput& input) { input.material.pair.b = -1; });
  refuses([](RestInput& input) { input.surface.faces[0][1] = 8; });
  refuses([](RestInput& input) { input.surface.faces.clear(); });
  refuses([](RestInput& input) { input.positions[5].z() = INFINITY; });
}

}  // namespace sinew::test::measure_test

// SPDX-License-Identifier: GPL-3.0-or-later
// What single precision preserves: small strains, rest, the balance of energy and the shape of a
// bend.
#include "support/all_steppers.h"

namespace sinew::single_precision_test {

constexpr double r = 0.01;

/// A bar of 200 diameters far from the origin, two bones along it, both at rest.
struct LongBar {
  Settings settings = test::in(Precision::binary32, test::box_scene(283));
  Points rest = test::fcc_box(5, 5, 283, r);

  explicit LongBar(const Vec3& place) {
    for (Vec3& point : rest) point += place;
    for (BoneDefinition& bone : settings.bones) {
      if (bone.head) *bone.head += place;
      *bone.tail += place;
    }
  }
};

const Vec3 far_away(300, -500, 1000);  // m: some 200 lengths of the bar

Points pair_forces_on(const Settings& settings, const Points& rest, const Particles& particles) {
  return test::simulation_from(settings, rest, particles, 1e-3).forces().pair;
}

double rms(const Points& vectors) {
  double sum = 0;
  for (const Vec3& vector : vectors) sum += vector.squaredNorm();
  return std::sqrt(sum / static_cast<double>(vectors.size()));
}

Points difference(const Points& a, const Points& b) {
  Points difference(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) difference[i] = a[i] - b[i];
  return difference;
}

/// How far single precision is from double, relative to double, over all particles.
double relative_error(const LongBar& bar, const Particles& particles) {
  Settings doubles = test::in(Precision::binary64, bar.settings);
  const Points exact = pair_forces_on(doubles, bar.rest, particles);
  return rms(difference(pair_forces_on(bar.settings, bar.rest, particles), exact)) / rms(exact);
}

TEST(SinglePrecision, FeelsAStrainOf1e_5OnABarOf200DiametersFarFromTheOrigin) {
  const LongBar bar(far_away);
  const Material material = test::material_of(bar.settings);
  const Vec3 foot = bar.rest.front();
  for (const double sign : {1.0, -1.0}) {
    Particles stretched = particles_at(bar.rest, r, material.mass);
    for (std::size_t i = 0; i < bar.rest.size(); ++i)  // the bonds across the axis stay as they are
      stretched.set_position(i, bar.rest[i] + Vec3(0, 0, sign * 1e-5 * (bar.rest[i] - foot).z()));
    EXPECT_LT(relative_error(bar, stretched), 0.06);
  }
  Particles stirred = test::shaken(bar.rest, material, 1e-5 * 2 * r, 0);
  EXPECT_LT(relative_error(bar, stirred), 0.02);
}

TEST(SinglePrecision, FeelsTheSameForceAtBothEndsOfALongBar) {
  const LongBar bar(far_away);
  Particles stirred = particles_at(bar.rest, r, test::material_of(bar.settings).mass);
  // Both ends are compressed alike: their forces mirror each other.
  const double push = 1e-4 * r;
  const Vec3 first = bar.rest.front(), last = bar.rest.back();
  stirred.set_position(0, first + Vec3(0, 0, push));
  stirred.set_position(bar.rest.size() - 1, last - Vec3(0, 0, push));
  const Points forces = pair_forces_on(bar.settings, bar.rest, stirred);
  EXPECT_NEAR(forces.front().z(), -forces.back().z(), 0.01 * std::abs(forces.front().z()));
  EXPECT_LT(forces.front().z(), 0);
}

TEST(SinglePrecision, LeavesABodyAtRestAtRest) {
  const LongBar bar(far_away);
  Simulation simulation = test::make_simulation(bar.settings, bar.rest);
  while (simulation.steps() < 1000) simulation.step();
  const Particles& now = simulation.particles();
  double most = 0;
  for (std::size_t i = 0; i < now.size(); ++i)
    most = std::max(most, (now.position(i) - bar.rest[i]).norm());
  EXPECT_LT(most, 1e-5 * r);
  const double step = simulation.time() / static_cast<double>(simulation.steps());
  EXPECT_LT(test::largest_speed(now) * step, 1e-6 * r);
  EXPECT_EQ(simulation.list_counts().rebuilds, 1);
}

Settings bend_scene(Precision precision, Integrator integrator = Integrator::symplectic_euler) {
  Settings settings = test::in(precision, test::box_scene(33));
  settings.solver.integrator = integrator;
  settings.tracks = {test::track("upper", {test::bend_key(0, 0), test::bend_key(0.3, 40)})};
  return settings;
}

Points box() { return test::fcc_box(7, 7, 33, r); }

// A bend that continues until a bond snaps makes the two differ by more: the bond snaps a little
// sooner or later.
TEST(SinglePrecision, BendsAsDoublePrecisionDoes) {
  for (const Integrator integrator : {Integrator::symplectic_euler, Integrator::velocity_verlet}) {
    Simulation floats = test::make_simulation(bend_scene(Precision::binary32, integrator), box());
    Simulation doubles = test::make_simulation(bend_scene(Precision::binary64, integrator), box());
    while (doubles.time() < 0.6) floats.step(), doubles.step();
    const Points a = positions_of(floats.particles()), b = positions_of(doubles.particles());
    EXPECT_LT(rms(difference(a, b)), 1e-5 * r);
    const Vec3 tip_a = a.back() - a[a.size() / 2], tip_b = b.back() - b[b.size() / 2];
    EXPECT_LT(degrees(std::atan2(tip_a.cross(tip_b).norm(), tip_a.dot(tip_b))), 1e-4);
  }
}

TEST(SinglePrecision, ClosesTheBalanceOfEnergyAsDoublePrecisionDoes) {
  const auto residual = [](Precision precision) {
    Simulation simulation = test::make_simulation(bend_scene(precision), box());
    const double start = simulation.energies().stored();
    while (simulation.time() < 0.6) simulation.step();
    const Energies end = simulation.energies();
    return (end.stored() - start - end.work_of_bones + end.dissipation) / end.work_of_bones;
  };
  const double doubles = residual(Precision::binary64), floats = residual(Precision::binary32);
  EXPECT_LT(std::abs(floats), 0.005);
  EXPECT_NEAR(floats, doubles, 1e-3);
}

TEST(SinglePrecision, GivesTheEnergiesOfDoublePrecision) {
  const Points rest = box();
  const Settings settings = bend_scene(Precision::binary32);
  const Particles particles = test::shaken(rest, test::material_of(settings), 0.3 * r, 0.1);
  Simulation floats = test::simulation_from(settings, rest, particles, 1e-3);
  Simulation doubles =
      test::simulation_from(bend_scene(Precision::binary64), rest, particles, 1e-3);
  const Energies a = floats.energies(), b = doubles.energies();
  EXPECT_NEAR(a.pair, b.pair, 2e-6 * std::abs(b.pair));
  EXPECT_NEAR(a.bone, b.bone, 2e-6 * b.bone);
  EXPECT_NEAR(a.kinetic, b.kinetic, 2e-6 * b.kinetic);
}

}  // namespace sinew::single_precision_test

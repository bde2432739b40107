// SPDX-License-Identifier: GPL-3.0-or-later
// Bones that are moved by hand, the forces of a program's own, and what is measured while stepping.
#include <sinew/rig/posing.h>

#include <gtest/gtest.h>

#include <sinew/run/particle_meter.h>
#include <sinew/world/own_forces.h>
#include "support/expect_error.h"
#include "support/world.h"

namespace sinew::posing_test {

constexpr double r = 0.01;

Quat about_y(double angle) { return Quat(Eigen::AngleAxisd(radians(angle), Vec3::UnitY())); }

/// A bar on two bones, the upper of which bends by 30 degrees within 0.4 s.
Settings bending() {
  Settings settings = test::box_scene(25);
  settings.tracks = {test::track("upper", {test::bend_key(0, 0), test::bend_key(0.4, 30)})};
  return settings;
}

double angle_of(const Skeleton& skeleton, const Motion& motion, double time) {
  const Mat3 turn = pose_at(skeleton, motion, time)[1].turn;
  return degrees(std::atan2(turn(0, 2), turn(0, 0)));
}

TEST(Posing, GoesFromWhereTheMotionIsToTheNewRotationAndStays) {
  const Prepared bar = test::prepared(bending(), test::fcc_box(7, 7, 25, r));
  const Skeleton& skeleton = bar.body.skeleton;
  Posing posing(skeleton, bar.motion);
  posing.turn({{"upper", about_y(70)}}, 0.2, 0.5);
  EXPECT_NEAR(angle_of(skeleton, posing.motion(), 0.2), 15, 1e-9);
  EXPECT_NEAR(angle_of(skeleton, posing.motion(), 0.45), (15 + 70) / 2.0, 1e-9);
  EXPECT_NEAR(angle_of(skeleton, posing.motion(), 0.7), 70, 1e-9);
  EXPECT_NEAR(angle_of(skeleton, posing.motion(), 9), 70, 1e-9);
  posing.turn({{"lower", Quat::Identity()}}, 0.8, 0.1);  // the upper bone keeps its target
  EXPECT_NEAR(angle_of(skeleton, posing.motion(), 2), 70, 1e-9);
}

TEST(Posing, IsTheSameMotionAsInATrack) {
  Settings settings = test::box_scene(25);
  const Points rest = test::fcc_box(7, 7, 25, r);
  Simulation posed = test::make_simulation(settings, rest);
  Posing posing(posed.body().skeleton, {});
  posing.turn({{"upper", about_y(25)}}, 0, 0.1);
  posed.play(posing.motion());
  Prepared tracked = test::prepared(settings, rest);
  settings.tracks = {test::track("upper", {test::bend_key(0, 0), test::bend_key(0.1, 25)})};
  tracked.motion = motion_of(settings, tracked.body.skeleton);
  Simulation other = start(std::move(tracked));
  for (int k = 0; k < 100; ++k) posed.step(), other.step();
  for (std::size_t i = 0; i < rest.size(); ++i)
    EXPECT_LT((posed.particles().position(i) - other.particles().position(i)).norm(), 1e-9 * r);
}

TEST(Posing, RefusesWhatItCannotDoAndStaysAsItIs) {
  const Skeleton skeleton = skeleton_of(test::box_scene(25));
  Posing posing(skeleton, {});
  posing.turn({{"upper", about_y(20)}}, 0, 1);
  test::expect_bad_input(
      [&] {
        posing.turn({{"uper", about_y(1)}}, 0, 1);
      },
      {"'uper'", "lower, upper"});
  test::expect_bad_input([&] { posing.turn({{"upper", Quat(0, 0, 0, 0)}}, 0, 1); }, {"quaternion"});
  for (const double over : {0.0, -1.0, std::nan("")})
    test::expect_bad_input([&] { posing.turn({}, 0, over); }, {"a pose takes no time"});
  EXPECT_NEAR(angle_of(skeleton, posing.motion(), 2), 20, 1e-9);
}

/// A body that nothing holds: a force on each particle moves it by a t^2 / 2.
TEST(OwnForces, AccelerateAsNewtonSays) {
  Settings settings = test::unbound(test::box_scene(25));
  settings.material.damping = 0;
  const Points rest = test::fcc_box(7, 7, 25, r);
  Prepared prepared = test::prepared(settings, rest);
  const double mass = prepared.filled.particles.mass;
  OwnForces own(rest.size());
  prepared.body.world = own.added_to(prepared.body.world);
  Simulation simulation = start(std::move(prepared));
  own.set(Points(rest.size(), mass * Vec3(0, 0, 2)));
  while (simulation.steps() < 200) simulation.step();
  const double t = simulation.time();
  for (const Vec3& v : {simulation.particles().velocity(0), simulation.particles().velocity(99)})
    EXPECT_NEAR(v.z(), 2 * t, 1e-9 * t);
  test::expect_bad_input([&] { own.set(Points(3, Vec3::Zero())); }, {"3 forces"});
  test::expect_bad_input([&] { own.set(Points(rest.size(), Vec3::Constant(NAN))); }, {"finite"});
}

Triangles one_triangle() { return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}; }

/// Along z, by a strain of e.
void draw_out(Prepared& prepared, const Points& rest, double e) {
  for (std::size_t i = 0; i < rest.size(); ++i)
    prepared.filled.particles.set_position(i, Vec3(1, 1, 1 + e).cwiseProduct(rest[i]));
}

/// A bonded body drawn out evenly: the closed form of its strain, at once.
TEST(ParticleMeter, SeesTheStrainOfThePresentMoment) {
  Settings settings = test::box_scene(25);
  settings.material.model = MaterialModel::bonded;
  const Points rest = test::fcc_box(7, 7, 25, r);
  Prepared prepared = test::prepared(settings, rest);
  ParticleMeter meter(prepared.body, one_triangle());
  const double e = 0.01;
  draw_out(prepared, rest, e);
  Simulation simulation = start(std::move(prepared));
  const std::vector<Column> found = meter.arrays(simulation, "strain");
  ASSERT_EQ(found.size(), 1u);
  ASSERT_EQ(found[0].components, 6);
  const auto& strain = std::get<std::vector<double>>(found[0].values);
  for (std::size_t i = 0; i < rest.size(); ++i) {
    EXPECT_NEAR(strain[6 * i + 2], ((1 + e) * (1 + e) - 1) / 2, 1e-12) << i;
    EXPECT_NEAR(strain[6 * i], 0, 1e-12) << i;
  }
  test::expect_bad_input([&] { (void)meter.arrays(simulation, "strian"); }, {"strian"});
}

/// A bonded body drawn out evenly, of two materials: each has the stress of its own modulus.
TEST(ParticleMeter, SeesTheStressOfPartsByTheirOwnModulus) {
  Settings settings = test::box_scene(25);
  settings.material.model = MaterialModel::bonded;
  LocalMaterialSettings stiff;
  stiff.name = "stiff", stiff.young_modulus = 5e4;
  settings.material.young_modulus = 1e4;
  stiff.part.region.low = Vec3(-1, -1, 0.17), stiff.part.region.high = Vec3(1, 1, 1);
  settings.materials = {stiff};
  const Points rest = test::fcc_box(7, 7, 25, r);
  Prepared prepared = test::prepared(settings, rest);
  ParticleMeter meter(prepared.body, one_triangle());
  const double e = 1e-4;
  draw_out(prepared, rest, e);
  const std::vector<double> modulus = prepared.body.stiffness;
  ASSERT_EQ(modulus.size(), rest.size());
  Simulation simulation = start(std::move(prepared));
  const auto stress = std::get<std::vector<double>>(meter.arrays(simulation, "stress")[0].values);
  // Lame's constants are equal where bonds pull along their lines: lambda + 2 mu = 6/5 E.
  int inner = 0;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const bool far = std::abs(rest[i].z() - 0.17) > 4 * r;
    if (!far || meter.rest().bonds_of(i) < 18) continue;
    EXPECT_NEAR(stress[6 * i + 2] / (1.2 * 1e4 * modulus[i] * e), 1, 0.1);
    ++inner;
  }
  EXPECT_GT(inner, 50);
}

/// Densities times the volumes of their particles sum up to the energy that the kernel counts.
TEST(ParticleMeter, SeesTheEnergyOfThePairsWhereItIs) {
  for (const MaterialModel model :
       {MaterialModel::paper, MaterialModel::bonded, MaterialModel::bonded_volume}) {
    Settings settings = bending();
    settings.material.model = model;
    Prepared prepared = test::prepared(settings, test::fcc_box(7, 7, 25, r));
    ParticleMeter meter(prepared.body, one_triangle());
    Simulation simulation = start(std::move(prepared));
    while (simulation.time() < 0.2) simulation.step();
    const std::vector<Column> found = meter.arrays(simulation, "energy_density");
    const auto& density = std::get<std::vector<double>>(found[0].values);
    const std::vector<double>& share = meter.rest().stiffness().volume_share;
    double sum = 0;
    for (std::size_t i = 0; i < density.size(); ++i)
      sum += density[i] * (share.empty() ? 1 : share[i]) * volume_per_particle(r);
    const double counted = simulation.energies().pair;
    EXPECT_GT(std::abs(counted), 1e-6);
    EXPECT_NEAR(sum / counted, 1, 1e-9) << static_cast<int>(model);
  }
}

}  // namespace sinew::posing_test

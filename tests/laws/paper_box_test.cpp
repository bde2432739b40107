// SPDX-License-Identifier: GPL-3.0-or-later
// The paper's box, 2,965 particles on two bones: its figure 4 in numbers.
#include <gtest/gtest.h>
#include <algorithm>

#include <sinew/scene/rig.h>

#include "support/world.h"

namespace sinew::paper_box_test {

constexpr double r = 0.010;

Points box() { return test::fcc_box(11, 11, 49, r); }

Settings bend_scene() {
  Settings settings = test::box_scene();
  settings.tracks = {test::track("upper", {test::bend_key(0, 0), test::bend_key(1, 90)})};
  return settings;
}

Settings twist_scene() {
  Settings settings = test::box_scene();
  settings.binding.joint_zone = 3;
  settings.binding.twist_stiffness = 6.4;
  settings.tracks = {test::track("upper", {test::twist_key(0, 0), test::twist_key(1, 90)})};
  return settings;
}

/// Where the particles are at each of the times (s, ascending).
std::vector<Points> run(const Settings& settings, const std::vector<double>& times) {
  Simulation simulation = test::make_simulation(settings, box());
  std::vector<Points> states;
  for (const double time : times) {
    while (simulation.time() < time - 1e-9) simulation.step();
    states.push_back(positions_of(simulation.particles()));
  }
  return states;
}

/// Root mean square distance of two states over the particles that `counts`.
template <class Counts>
double rms(const Points& a, const Points& b, Counts&& counts) {
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (counts(i)) sum += (a[i] - b[i]).squaredNorm(), ++count;
  return std::sqrt(sum / count);
}

int inverted(const Points& now) {
  const RestShape rest = rest_shape(box(), rest_neighbor_range(r));
  const auto gradients = test::deformation_gradients(rest, now);
  return static_cast<int>(std::count_if(gradients.begin(), gradients.end(),
                                        [](const Mat3& F) { return F.determinant() <= 0; }));
}

/// The fraction of neighbors at rest that are b or more apart.
double broken(const Points& now, double b) {
  const auto lists = neighbors_within(box(), rest_neighbor_range(r));
  double pairs = 0, apart = 0;
  for (std::size_t i = 0; i < now.size(); ++i)
    for (const auto j : lists.of(i)) ++pairs, apart += (now[i] - now[j]).norm() >= b;
  return apart / pairs;
}

TEST(PaperBox, AtRestStaysAtRestFor10000Steps) {
  Simulation simulation =
      test::make_simulation(test::box_scene(), test::fcc_box(11, 11, 49, 0.010));
  ASSERT_EQ(simulation.particles().size(), 2965u);
  while (simulation.steps() < 10000) simulation.step();
  EXPECT_LT(test::largest_speed(simulation.particles()), 1e-13);
}

TEST(PaperBox, BentBy90DegreesFollowsItsBoneAndSettles) {
  const auto states = run(bend_scene(), {1.0, 1.25, 1.5});
  const Skeleton skeleton = skeleton_of(bend_scene());
  const Pose pose = pose_at(skeleton, motion_of(bend_scene(), skeleton), 1.5);
  const Points rest = box();
  Points rigid;
  for (const Vec3& point : rest)
    rigid.push_back(carried(point, skeleton.bones[1].rest, pose[1].frame));
  const double three_quarters = 0.75 * 49 * half_plane_spacing(r);
  const auto far_half = [&](std::size_t i) { return rest[i].z() > three_quarters; };
  const auto all = [](std::size_t) { return true; };
  EXPECT_LT(rms(states.back(), rigid, far_half), 2 * r);
  EXPECT_LE(inverted(states.back()), 3);
  EXPECT_LT(broken(states.back(), 2.6 * r), 0.05);
  EXPECT_LT(rms(states[1], states[2], all), 0.2 * r) << "settled";
}

/// How far each half-plane above `from` has rotated about z since rest, in degrees.
std::vector<double> turns_of_planes(const Points& now, int from) {
  const Points rest = box();
  std::vector<double> sine(49, 0.0), cosine(49, 0.0), turns;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const int plane = static_cast<int>(rest[i].z() / half_plane_spacing(r));
    const Vec3 before(rest[i].x(), rest[i].y(), 0), after(now[i].x(), now[i].y(), 0);
    sine[plane] += before.cross(after).z();
    cosine[plane] += before.dot(after);
  }
  for (int plane = from; plane < 49; ++plane)
    turns.push_back(degrees(std::atan2(sine[plane], cosine[plane])));
  return turns;
}

TEST(PaperBox, TwistedBy90DegreesTurnsItsTipWithoutACut) {
  const Points now = run(twist_scene(), {2.0}).back();
  const auto turns = turns_of_planes(now, 0);
  EXPECT_NEAR(turns.back(), 90, 1);
  EXPECT_NEAR(turns.front(), 0, 1);
  double jump = 0;
  for (std::size_t plane = 1; plane < turns.size(); ++plane)
    jump = std::max(jump, std::abs(turns[plane] - turns[plane - 1]));
  EXPECT_LT(jump, 5);
  EXPECT_LE(broken(now, 2.6 * r), 0.01);
}

TEST(PaperBox, TwistedWithoutAJointZoneIsCut) {
  Settings settings = twist_scene();
  settings.binding.joint_zone = 0;
  const auto turns = turns_of_planes(run(settings, {2.0}).back(), 0);
  double jump = 0;
  for (std::size_t plane = 1; plane < turns.size(); ++plane)
    jump = std::max(jump, std::abs(turns[plane] - turns[plane - 1]));
  EXPECT_GT(jump, 20);
}

/// Nothing answers the open twist force but the damping of the bones: m dL/dt = m M - c L, of the
/// moment M = theta sum w k_tau rho^2 and the angular momentum L about the bones.
TEST(PaperBox, TwistedByAnOpenLoopSpinsAsFastAsItsBonesDamp) {
  Settings settings = test::box_scene();
  settings.binding.joint_zone = 3;
  settings.binding.twist_form = TwistForm::open_loop;
  settings.material.damping_form = DampingForm::central;  // the paper's own brakes what turns
  settings.tracks = {test::track("upper", {test::twist_key(0, 0), test::twist_key(0.25, 20)})};
  Simulation simulation = test::make_simulation(settings, box());
  while (simulation.time() < 0.5 - 1e-9) simulation.step();
  const Body& body = simulation.body();
  const Particles& now = simulation.particles();
  double momentum = 0, moment = 0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const Vec3 place = now.position(i);
    momentum += now.mass * place.cross(now.velocity(i)).z();
    for (const Influence& influence : body.binding.of(static_cast<std::size_t>(now.id[i])))
      if (influence.bone == 1)
        moment +=
            influence.weight * body.springs[1].twist * radians(20) * place.head<2>().squaredNorm();
  }
  ASSERT_NEAR(body.springs[0].damping, body.springs[1].damping, 1e-12);
  EXPECT_NEAR(momentum, now.mass * moment / body.springs[1].damping, 0.02 * momentum);
  const auto turns = turns_of_planes(positions_of(now), 0);
  EXPECT_GT(turns.back(), 2 * 20) << "the tip has overtaken its bone";
}

double speed_after_noise(double b_in_radii) {
  Settings settings = test::box_scene();
  settings.material.b = b_in_radii;
  const Body body = test::make_body(settings, box());
  const double limit = step_limit(Integrator::symplectic_euler, body.material, body.springs);
  Simulation simulation = test::simulation_from(
      settings, box(), test::shaken(box(), body.material, 1e-13 * r, 0), 0.5 * limit);
  while (simulation.time() < 0.5) simulation.step();
  return test::largest_speed(simulation.particles());
}

TEST(PaperBox, AtRestIsUnstableWithTheLiteralRangeAndStableBelow2Point75Radii) {
  EXPECT_GT(speed_after_noise(2 * std::sqrt(2.0)), 0.05);
  EXPECT_LT(speed_after_noise(2.6), 1e-12);
  EXPECT_LT(speed_after_noise(2.75), 1e-12);
}

}  // namespace sinew::paper_box_test

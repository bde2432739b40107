// SPDX-License-Identifier: GPL-3.0-or-later
// The motion of a body does not depend on direction, place, handedness, uniform motion, or the
// numbering of its particles: runs that differ only in these are the same, transformed, but for
// rounding.
#include <gtest/gtest.h>
#include <algorithm>
#include <numeric>
#include <random>

#include "support/all_steppers.h"

namespace sinew::symmetry_test {

constexpr double r = 0.01;
constexpr int half_planes = 25;
constexpr int steps = 120;

/// A bend, a twist and a shift at once, under gravity and with a joint zone.
Settings everything_at_once() {
  Settings settings = test::box_scene(half_planes);
  settings.binding.joint_zone = 2;
  settings.solver.gravity = {0.5, 0, -2};
  KeyDefinition end = test::bend_key(0.3, 50);
  end.twist = 40;
  end.translation = {0.3 * r, 0, 0.5 * r};
  settings.tracks = {test::track("lower", {test::bend_key(0, 0), test::bend_key(0.3, -20)}),
                     test::track("upper", {test::bend_key(0, 0), end})};
  return settings;
}

Points box() { return test::fcc_box(5, 5, half_planes, r); }

/// A body with its own start, with the steppers that support it.
struct Case {
  std::string name;
  Settings settings;
  double tolerance;  ///< radii
};

std::vector<Case> cases() {
  const Settings lists = everything_at_once();
  Settings bonded = lists;
  bonded.material.model = MaterialModel::bonded_volume;
  Settings central = lists;
  central.material.damping_form = DampingForm::central;
  Settings anchored = lists;
  anchored.binding.force = BoneForce::anchor;
  return {{"lists", lists, 1e-10},
          {"lists in single precision", test::in(Precision::binary32, lists), 1e-3},
          {"cells", test::with_cells(lists), 1e-10},
          {"bonded_volume", bonded, 1e-10},
          {"central damping", central, 1e-10},
          {"anchors", anchored, 1e-10}};
}

Particles shaken_box(const Settings& settings, const Points& rest) {
  return test::shaken(rest, test::material_of(settings), 0.02 * r, 0.05);
}

/// Where the particles are after a while.
Points run(const Settings& settings, const Points& rest, const Particles& start) {
  const Body body = test::make_body(settings, rest);
  Simulation simulation =
      test::simulation_from(settings, rest, start, test::step_of(settings, body, 0.4));
  while (simulation.steps() < steps) simulation.step();
  return positions_of(simulation.particles());
}

double largest_distance(const Points& a, const Points& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, (a[i] - b[i]).norm());
  return most;
}

/// The whole scene turned about the origin and shifted.
Settings moved(Settings settings, const Mat3& turn, const Vec3& shift) {
  for (BoneDefinition& bone : settings.bones) {
    if (bone.head) *bone.head = turn * *bone.head + shift;
    if (bone.tail) *bone.tail = turn * *bone.tail + shift;
  }
  for (TrackDefinition& track : settings.tracks)
    for (KeyDefinition& key : track.keys) {
      if (key.axis) *key.axis = turn * *key.axis;
      key.translation = turn * key.translation;
    }
  settings.solver.gravity = turn * settings.solver.gravity;
  return settings;
}

Particles moved(Particles particles, const Mat3& turn, const Vec3& shift) {
  for (std::size_t i = 0; i < particles.size(); ++i) {
    particles.set_position(i, turn * particles.position(i) + shift);
    particles.set_velocity(i, turn * particles.velocity(i));
  }
  return particles;
}

/// Runs the scene as it is and moved: the one moved is the other, but for `rounding` (m).
void expect_same_when_moved(const Mat3& turn, const Vec3& shift, double rounding = 0) {
  const Points rest = box();
  for (const Case& one : cases()) {
    const Particles start = shaken_box(one.settings, rest);
    const Points here = run(one.settings, rest, start),
                 there = run(moved(one.settings, turn, shift), test::affine(rest, turn, shift),
                             moved(start, turn, shift));
    EXPECT_LT(largest_distance(test::affine(here, turn, shift), there),
              one.tolerance * r + rounding)
        << one.name;
  }
}

TEST(Symmetry, ATurnedSceneRunsTurned) {
  expect_same_when_moved(test::turned({1, -2, 3}, 77), Vec3::Zero());
}

TEST(Symmetry, AShiftedSceneRunsShifted) {
  expect_same_when_moved(Mat3::Identity(), {0.4, -1.7, 0.9});
}

TEST(Symmetry, ASceneFarAwayRunsAsAtTheOrigin) {
  expect_same_when_moved(Mat3::Identity(), {std::ldexp(0.25, 24), 0, 0}, 1e-4 * r);
}

/// A twist changes sign in a mirror, as do angles about an axis.
TEST(Symmetry, AMirroredSceneRunsMirrored) {
  const Points rest = box();
  const Mat3 mirror = Vec3(1, -1, 1).asDiagonal();
  for (const Case& one : cases()) {
    Settings other = moved(one.settings, mirror, Vec3::Zero());
    for (TrackDefinition& track : other.tracks)
      for (KeyDefinition& key : track.keys) key.angle = -*key.angle, key.twist = -key.twist;
    const Particles start = shaken_box(one.settings, rest);
    const Points here = run(one.settings, rest, start),
                 there = run(other, test::affine(rest, mirror), moved(start, mirror, Vec3::Zero()));
    EXPECT_LT(largest_distance(test::affine(here, mirror), there), one.tolerance * r) << one.name;
  }
}

/// The index of each point's image by y -> -y.
std::vector<std::size_t> images(const Points& points) {
  std::vector<std::size_t> image;
  for (const Vec3& point : points) {
    const Vec3 wanted(point.x(), -point.y(), point.z());
    image.push_back(static_cast<std::size_t>(std::min_element(points.begin(), points.end(),
                                                              [&](const Vec3& a, const Vec3& b) {
                                                                return (a - wanted).squaredNorm() <
                                                                       (b - wanted).squaredNorm();
                                                              }) -
                                             points.begin()));
  }
  return image;
}

/// Without a joint zone: in one, tissue inside a bend may move to the far side of a bone's axis,
/// 180 degrees from its place, and rounding decides in which direction it is rotated back.
TEST(Symmetry, ASymmetricBodyThatBendsStaysSymmetric) {
  const Points rest = box();
  const std::vector<std::size_t> image = images(rest);
  for (Case one : cases()) {
    one.settings.binding.joint_zone = 0;
    one.settings.tracks = {test::track("upper", {test::bend_key(0, 0), test::bend_key(0.3, 60)})};
    const Particles start = particles_at(rest, r, test::material_of(one.settings).mass);
    const Points bent = run(one.settings, rest, start);
    EXPECT_GT(largest_distance(bent, rest), 2 * r) << one.name;
    for (std::size_t i = 0; i < bent.size(); ++i) {
      const Vec3 other(bent[image[i]].x(), -bent[image[i]].y(), bent[image[i]].z());
      ASSERT_LT((bent[i] - other).norm(), one.tolerance * r) << one.name << ", particle " << i;
    }
  }
}

std::vector<std::size_t> shuffled(std::size_t size) {
  std::vector<std::size_t> order(size);
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(11));
  return order;
}

TEST(Symmetry, RenumberedParticlesMoveAlike) {
  const Points rest = box();
  const std::vector<std::size_t> order = shuffled(rest.size());
  Points other_rest;
  for (const std::size_t i : order) other_rest.push_back(rest[i]);
  for (const Case& one : cases()) {
    const Particles start = shaken_box(one.settings, rest);
    Particles other = test::reordered(start, order);
    std::iota(other.id.begin(), other.id.end(), 0);
    const Points a = run(one.settings, rest, start), b = run(one.settings, other_rest, other);
    for (std::size_t i = 0; i < order.size(); ++i)
      ASSERT_LT((b[i] - a[order[i]]).norm(), one.tolerance * r) << one.name << ", " << i;
  }
}

/// The paper's damping and the bones' depend only on differences of velocity.
TEST(Symmetry, AnEvenMotionOfEverythingChangesNothing) {
  const Points rest = box();
  const Vec3 wind(0.3, -0.2, 0.4);
  for (const Case& one : cases()) {
    Settings still = one.settings;
    still.tracks.erase(still.tracks.begin());
    Settings carried = still;
    KeyDefinition begin = test::bend_key(-1, 0), end = test::bend_key(1, 0);
    begin.translation = -wind, end.translation = wind;
    carried.tracks.push_back(test::track("lower", {begin, end}));
    carried.tracks.back().interpolation = Interpolation::linear;
    const Particles start = shaken_box(still, rest);
    Particles moving = start;
    for (std::size_t i = 0; i < rest.size(); ++i) moving.set_velocity(i, start.velocity(i) + wind);
    const Body body = test::make_body(still, rest);
    const double time = steps * test::step_of(still, body, 0.4);
    EXPECT_LT(largest_distance(test::affine(run(still, rest, start), Mat3::Identity(), time * wind),
                               run(carried, rest, moving)),
              one.tolerance * r)
        << one.name;
  }
}

}  // namespace sinew::symmetry_test

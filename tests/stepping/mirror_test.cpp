// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes that are symmetric stay so, and a scene that is turned gives a run that is turned.
#include <gtest/gtest.h>
#include <map>

#include <sinew/core/text.h>

#include "support/world.h"

namespace sinew::mirror_test {

constexpr double r = 0.01;

/// A bend by 70 degrees about y.
Settings bend(double joint_zone, MaterialModel model) {
  Settings settings = test::box_scene();
  settings.binding.joint_zone = joint_zone;
  settings.material.model = model;
  settings.tracks = {test::track("upper", {test::bend_key(0, 0), test::bend_key(0.5, 70)})};
  return settings;
}

Points after(Simulation simulation, double time) {
  while (simulation.time() < time) simulation.step();
  return positions_of(simulation.particles());
}

/// The place of each point's image in the plane y = 0.
std::vector<std::size_t> images(const Points& points) {
  std::map<std::array<long, 3>, std::size_t> place;
  const auto key = [](const Vec3& p) {
    return std::array{std::lround(p.x() / r * 100), std::lround(p.y() / r * 100),
                      std::lround(p.z() / r * 100)};
  };
  for (std::size_t i = 0; i < points.size(); ++i) place[key(points[i])] = i;
  std::vector<std::size_t> images;
  for (const Vec3& p : points) images.push_back(place.at(key({p.x(), -p.y(), p.z()})));
  return images;
}

class Bends : public testing::TestWithParam<std::tuple<double, MaterialModel>> {};

TEST_P(Bends, AreTheSameOnBothSides) {
  const auto [joint_zone, model] = GetParam();
  const Points rest = test::fcc_box(11, 11, 49, r);
  const Points end = after(test::make_simulation(bend(joint_zone, model), rest), 0.6);
  const std::vector<std::size_t> image = images(rest);
  double most = 0, moved = 0;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const Vec3& other = end[image[i]];
    most = std::max(most, (end[i] - Vec3(other.x(), -other.y(), other.z())).norm());
    moved = std::max(moved, (end[i] - rest[i]).norm());
  }
  EXPECT_LT(most, 1e-6 * r);
  EXPECT_GT(moved, 20 * r);
}

INSTANTIATE_TEST_SUITE_P(Of, Bends,
                         testing::Combine(testing::Values(0.0, 0.5, 1.0, 2.0),
                                          testing::Values(MaterialModel::paper,
                                                          MaterialModel::bonded)));

TEST(TurnedScenes, GiveTurnedRuns) {
  const Points rest = test::fcc_box(7, 7, 25, r);
  Settings settings = test::box_scene(25);
  settings.binding.joint_zone = 1;
  settings.material.model = MaterialModel::bonded;
  settings.tracks = {test::track("upper", {test::bend_key(0, 0), test::bend_key(0.3, 70)})};
  const Points end = after(test::make_simulation(settings, rest), 0.4);
  const Mat3 R = test::turned({1, 2, -1}, 77);
  const Vec3 shift(0.3, -0.2, 0.5);
  Settings turned = settings;
  for (BoneDefinition& bone : turned.bones) {
    if (bone.head) bone.head = R * *bone.head + shift;
    bone.tail = R * *bone.tail + shift;
  }
  for (KeyDefinition& key : turned.tracks[0].keys) key.axis = R * Vec3::UnitY();
  const Points turned_end = after(test::make_simulation(turned, test::affine(rest, R, shift)), 0.4);
  double most = 0;
  for (std::size_t i = 0; i < rest.size(); ++i)
    most = std::max(most, (turned_end[i] - (R * end[i] + shift)).norm());
  EXPECT_LT(most, 1e-6 * r);
}

}  // namespace sinew::mirror_test

// SPDX-License-Identifier: GPL-3.0-or-later
// The weights of a skin hold all over its triangles, however few vertices it has.
#include <sinew/scene/bind_scene.h>

#include <gtest/gtest.h>

#include "mesh/shapes.h"
#include "support/world.h"

namespace sinew::bind_scene_test {

constexpr double r = 0.01;

/// Two bones along z, from 0 to 1 m and from there to 2 m.
Skeleton two_bones() {
  Settings settings;
  settings.bones = {{"one", "", Vec3(0, 0, 0), Vec3(0, 0, 1)}, {"other", "one", {}, Vec3(0, 0, 2)}};
  return skeleton_of(settings);
}

/// A skin whose vertices have a weight between 0 and 1 on the other bone, by `share`.
template <class Share>
SceneFiles skin(const std::vector<PolygonSoup>& parts, const Share& share) {
  SceneFiles files;
  PolygonSoup& all = files.skeleton.mesh;
  for (const PolygonSoup& part : parts) {
    const int before = static_cast<int>(all.points.size());
    all.points.insert(all.points.end(), part.points.begin(), part.points.end());
    for (std::vector<int> polygon : part.polygons) {
      for (int& corner : polygon) corner += before;
      all.polygons.push_back(polygon);
    }
  }
  BoneWeights& weights = files.skeleton.weights;
  weights.first = {0};
  for (std::size_t i = 0; i < all.points.size(); ++i) {
    const double other = share(i, all.points[i]);
    for (const BoneWeight& one : {BoneWeight{0, 1 - other}, BoneWeight{1, other}})
      if (one.weight > 0) weights.weights.push_back(one);
    weights.first.push_back(static_cast<std::uint32_t>(weights.weights.size()));
  }
  return files;
}

Binding bound(const SceneFiles& files, const Points& rest, double scale = 1) {
  Settings settings;
  settings.skeleton.file = "skin.glb";
  settings.skeleton.scale = scale;
  settings.binding.method = BindMethod::file;
  return bind_scene(settings, files, two_bones(), rest, test::nearest(rest, r), r);
}

/// Points in a box, each 2 r from the next.
Points grid_in(const Box& box) {
  Points points;
  for (double z = box.min().z() + r; z < box.max().z(); z += 2 * r)
    for (double y = box.min().y() + r; y < box.max().y(); y += 2 * r)
      for (double x = box.min().x() + r; x < box.max().x(); x += 2 * r)
        points.emplace_back(x, y, z);
  return points;
}

/// A leg of eight corners beside a hand whose corners are nearer to the leg's middle than its own.
TEST(BindScene, LimbsKeepTheirBonesFarFromTheirVertices) {
  for (const double scale : {1.0, 100.0}) {
    const Vec3 low(0, 0, 0), high(0.1, 0.1, 1), hand_low(0.12, 0, 0.4), hand_high(0.22, 0.1, 0.6);
    const auto soup = [&](const Vec3& a, const Vec3& b) {
      return shapes::box(a / scale, b / scale);
    };
    const SceneFiles files = skin({soup(low, high), soup(hand_low, hand_high)},
                                  [](std::size_t i, const Vec3&) { return i < 8 ? 0.0 : 1.0; });
    Points rest = grid_in(Box(low, high));
    const std::size_t leg = rest.size();
    for (const Vec3& point : grid_in(Box(hand_low, hand_high))) rest.push_back(point);
    const Binding binding = bound(files, rest, scale);
    for (std::size_t i = 0; i < rest.size(); ++i)
      EXPECT_EQ(binding.bone(i), i < leg ? 0 : 1) << rest[i].transpose();
  }
}

/// The floor's area must not coarsen the leg, beside which is a hand.
TEST(BindScene, LargeFloorLeavesALegItsBone) {
  const Vec3 low(0, 0, 0), high(0.1, 0.1, 1);
  const SceneFiles files =
      skin({shapes::box(low, high), shapes::box({0.12, 0, 0.4}, {0.22, 0.1, 0.6}),
            shapes::box({-1000, -1000, -1}, {1000, 1000, -0.035})},
           [](std::size_t i, const Vec3&) { return i < 8 ? 0.0 : 1.0; });
  const Points rest = grid_in(Box(low, high));
  const Binding binding = bound(files, rest);
  for (std::size_t i = 0; i < rest.size(); ++i)
    EXPECT_EQ(rest[i].z() > 0.1 ? binding.bone(i) : 0, 0) << rest[i].transpose();
}

TEST(BindScene, WeightsAreLinearBetweenDistantVertices) {
  const SceneFiles files = skin({shapes::box({0, 0, 0}, {0.1, 0.1, 2})},
                                [](std::size_t, const Vec3& point) { return point.z() / 2; });
  const Points rest = grid_in(Box(Vec3(0, 0, 0.1), Vec3(0.1, 0.1, 1.9)));
  const Binding binding = bound(files, rest);
  for (std::size_t i = 0; i < rest.size(); ++i)
    for (const Influence& one : binding.of(i))
      EXPECT_NEAR(one.weight, one.bone == 1 ? rest[i].z() / 2 : 1 - rest[i].z() / 2, 0.02)
          << rest[i].transpose();
}

}  // namespace sinew::bind_scene_test

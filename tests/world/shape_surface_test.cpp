// SPDX-License-Identifier: GPL-3.0-or-later
// The surfaces with which obstacles are drawn lie on their shapes.
#include <gtest/gtest.h>
#include <set>

#include <sinew/world/shapes.h>

#include "support/world.h"

namespace sinew::shape_surface_test {

const Shape ball = SphereShape{{0.2, 0.1, -0.1}, 0.7};
const Shape capsule = CapsuleShape{{-0.4, 0, 0.1}, {0.5, 0.3, -0.2}, 0.3};
const Shape box = BoxShape{{0.1, -0.2, 0.3}, {0.5, 0.3, 0.8}, test::turned({1, 2, 3}, 40)};

/// Every edge occurs once in each direction.
bool is_closed(const Triangles& surface) {
  std::set<std::pair<int, int>> sides;
  for (const auto& face : surface.faces)
    for (int k = 0; k < 3; ++k)
      if (!sides.emplace(face[k], face[(k + 1) % 3]).second) return false;
  return std::all_of(sides.begin(), sides.end(), [&](const auto& side) {
    return sides.count({side.second, side.first}) == 1;
  });
}

TEST(ShapeSurface, IsClosedAndLiesOnTheShape) {
  for (const Shape& shape : {ball, capsule, box}) {
    const Triangles surface = surface_of(shape, 1);
    EXPECT_TRUE(is_closed(surface));
    for (const Vec3& point : surface.points)
      EXPECT_NEAR(signed_distance(shape, point).distance, 0, 1e-15);
    std::vector<int> uses(surface.points.size());
    for (const auto& face : surface.faces)
      for (const int corner : face) ++uses[static_cast<std::size_t>(corner)];
    EXPECT_EQ(std::count(uses.begin(), uses.end(), 0), 0);
  }
}

TEST(ShapeSurface, EnclosesTheVolumeOfTheShape) {
  EXPECT_NEAR(volume(surface_of(box, 1)), 8 * 0.5 * 0.3 * 0.8, 1e-15);
  const double of_ball = 4 * pi / 3 * std::pow(0.7, 3);
  EXPECT_NEAR(volume(surface_of(ball, 1)) / of_ball, 0.975, 0.005);  // as 24 meridians allow
  const double length = Vec3(0.9, 0.3, -0.3).norm(), round = 0.3 * 0.3 * pi;
  const double of_capsule = round * length * std::sin(2 * pi / 24) / (2 * pi / 24) +
                            4 * pi / 3 * std::pow(0.3, 3) * 0.975;
  EXPECT_NEAR(volume(surface_of(capsule, 1)) / of_capsule, 1, 0.003);
  EXPECT_EQ(surface_of(ball, 1).points.size(), 2u + 12 * 24);
}

TEST(ShapeSurface, OfAPlaneIsASquareThatFacesOutward) {
  const Triangles square = surface_of(PlaneShape{{0, 0.1, 0}, {1, 2, -2}}, 3);
  Vec3 middle = Vec3::Zero(), normal = Vec3::Zero();
  for (const Vec3& point : square.points) middle += point / 4;
  EXPECT_NEAR((middle - Vec3(0, 0.1, 0)).norm(), 0, 1e-15);
  for (const auto& [a, b, c] : square.faces)
    normal += (square.points[b] - square.points[a]).cross(square.points[c] - square.points[a]) / 2;
  EXPECT_NEAR((normal - 9 * Vec3(1, 2, -2) / 3).norm(), 0, 1e-14);
  EXPECT_NEAR(area(square), 9, 1e-14);
}

TEST(ShapeSurface, OfAMeshIsItsOwn) { EXPECT_TRUE(surface_of(MeshShape{}, 1).faces.empty()); }

}  // namespace sinew::shape_surface_test

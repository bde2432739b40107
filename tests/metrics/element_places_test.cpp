// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/element_places.h>

#include <gtest/gtest.h>

#include <random>

#include "support/expect_error.h"

namespace sinew::element_places_test {
namespace {

/// Two hexahedra side by side, skewed, of 20 nodes.
VolumeMesh two() {
  VolumeMesh mesh;
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 3; ++i)
        mesh.nodes.emplace_back(i + 0.3 * j + 0.1 * k, j + 0.2 * i * k, k);
  for (const std::uint32_t i : {0u, 1u})
    mesh.elements.push_back(
        {ElementKind::hexahedron8, {i, i + 1, i + 4, i + 3, i + 6, i + 7, i + 10, i + 9}});
  return second_order(mesh);
}

Vec3 field(const Vec3& at) { return {at.x() + 2 * at.y(), 3 - at.z(), at.x() - at.y()}; }

Points field_of(const VolumeMesh& mesh) {
  Points values;
  for (const Vec3& node : mesh.nodes) values.push_back(field(node));
  return values;
}

TEST(ElementPlaces, LinearFieldsAreExactWithinTheElements) {
  const VolumeMesh mesh = two();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> local(-1, 1);
  Points points;
  std::vector<std::uint32_t> element;
  for (int n = 0; n < 200; ++n) {
    element.push_back(n % 2);
    const VolumeElement& own = mesh.elements[element.back()];
    const ShapeFunctions at =
        shape_functions(own.kind, {local(random), local(random), local(random)});
    Vec3& point = points.emplace_back(Vec3::Zero());
    for (std::size_t k = 0; k < own.used().size(); ++k)
      point += at.value[k] * mesh.nodes[own.nodes[k]];
  }
  const auto places = places_in(mesh, points);
  for (std::size_t n = 0; n < points.size(); ++n) {
    EXPECT_EQ(places[n].element, element[n]);
    EXPECT_LT(places[n].outside, 1e-9);
    EXPECT_LT((value_at(mesh, places[n], field_of(mesh)) - field(points[n])).norm(), 1e-9);
  }
}

TEST(ElementPlaces, PointsBesideTheElementsSayHowFar) {
  VolumeMesh mesh;
  mesh.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.elements = {{ElementKind::tetrahedron4, {0, 1, 2, 3}}};
  const auto places = places_in(second_order(mesh), {{-0.1, 0.2, 0.2}, {50, 0, 0}});
  EXPECT_NEAR(places[0].outside, 0.1, 1e-9);
  EXPECT_LT((value_at(second_order(mesh), places[0], field_of(second_order(mesh))) -
             field({-0.1, 0.2, 0.2}))
                .norm(),
            1e-9);
  EXPECT_TRUE(std::isinf(places[1].outside));
  test::expect_bad_input([] { places_in({}, {Vec3::Zero()}); }, {"no elements"});
}

}  // namespace
}  // namespace sinew::element_places_test

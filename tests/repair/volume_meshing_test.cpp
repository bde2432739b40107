// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/repair/volume_meshing.h>

#include <gtest/gtest.h>

#include <algorithm>

#include <sinew/mesh/solids.h>
#include "support/expect_error.h"

namespace sinew::volume_meshing_test {
namespace {

using test::expect_bad_input;

double volume_of_all(const VolumeMesh& mesh) {
  double sum = 0;
  for (const VolumeElement& element : mesh.elements) sum += volume_of(mesh, element);
  return sum;
}

double min_volume(const VolumeMesh& mesh) {
  double least = volume_of_all(mesh);
  for (const VolumeElement& element : mesh.elements)
    least = std::min(least, volume_of(mesh, element));
  return least;
}

double skin_of(const VolumeMesh& mesh) {
  double sum = 0;
  for (const ElementFace& face : boundary_faces(mesh)) sum += area_vector(mesh, face).norm();
  return sum;
}

TEST(VolumeMeshing, ABoxIsFoundOnlyWhereTheSurfaceIsOne) {
  const auto box = axis_box(solid(SolidShape::box, {1, 2, 3}));
  ASSERT_TRUE(box.has_value());
  EXPECT_LT((box->sizes() - Vec3(1, 2, 3)).norm(), 1e-12);
  EXPECT_FALSE(axis_box(solid(SolidShape::cylinder, {1, 1, 1})).has_value());
  Triangles turned = solid(SolidShape::box, {1, 2, 3});
  for (Vec3& point : turned.points) point = Eigen::AngleAxisd(0.1, Vec3::UnitZ()) * point;
  EXPECT_FALSE(axis_box(turned).has_value());
}

TEST(VolumeMeshing, HexahedraFillTheBoxAndMeetAtCuts) {
  const Box box(Vec3(-1, 0, 0), Vec3(1, 1, 3));
  const VolumeMesh mesh = hexahedra(box, 0.6, {{{0.31}, {}, {1.4, 1.41}}});
  EXPECT_NEAR(volume_of_all(mesh), 6, 1e-12);
  EXPECT_NEAR(skin_of(mesh), 2 * (2 + 3 + 6), 1e-12);
  EXPECT_GT(min_volume(mesh), 0);
  const auto has = [&](int axis, double value) {
    return std::any_of(mesh.nodes.begin(), mesh.nodes.end(),
                       [&](const Vec3& node) { return node[axis] == value; });
  };
  EXPECT_TRUE(has(0, 0.31));
  EXPECT_TRUE(has(2, 1.4));
  EXPECT_FALSE(has(2, 1.41));  // nearer than a tenth of the size
  for (const VolumeElement& element : mesh.elements)
    for (const auto& [from, to] : edges_of(element.kind))
      EXPECT_LE((mesh.nodes[element.nodes[from]] - mesh.nodes[element.nodes[to]]).norm(),
                0.6 + 1e-12);
}

TEST(VolumeMeshing, TetrahedraFillABallAndKeepTheEdgesOfACylinder) {
  const Triangles ball = solid(SolidShape::sphere, {1, 1, 1});
  const VolumeMesh of_ball = tetrahedra(ball, 0.15);
  EXPECT_NEAR(volume_of_all(of_ball) / volume(ball), 1, 0.03);
  EXPECT_GT(min_volume(of_ball), 0);
  const Triangles cylinder = solid(SolidShape::cylinder, {1, 1, 1});
  const VolumeMesh of_cylinder = tetrahedra(cylinder, 0.2);
  EXPECT_NEAR(volume_of_all(of_cylinder) / volume(cylinder), 1, 0.02);
  double upper = 0;
  for (const ElementFace& face : boundary_faces(of_cylinder))
    if (area_vector(of_cylinder, face).normalized().z() > 0.999999)
      upper += area_vector(of_cylinder, face).z();
  EXPECT_NEAR(upper, pi / 4, 0.02);
}

TEST(VolumeMeshing, TetrahedraAreTheSameEachTime) {
  const Triangles ball = solid(SolidShape::sphere, {1, 1, 1});
  EXPECT_EQ(tetrahedra(ball, 0.3).nodes, tetrahedra(ball, 0.3).nodes);
}

TEST(VolumeMeshing, SurfacesThatBoundNothingAreRefused) {
  Triangles open = solid(SolidShape::sphere, {1, 1, 1});
  open.faces.pop_back();
  expect_bad_input([&] { tetrahedra(open, 0.3); }, {"the surface is open", "body.close_holes"});
  Triangles crossing = solid(SolidShape::sphere, {1, 1, 1});
  Triangles other = crossing;
  for (Vec3& point : other.points) point.x() += 0.4;
  append(other, crossing);
  expect_bad_input([&] { tetrahedra(crossing, 0.3); }, {"intersects itself", "body.wrap"});
}

}  // namespace
}  // namespace sinew::volume_meshing_test

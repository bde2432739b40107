// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/volume_mesh.h>

#include <gtest/gtest.h>

#include <numeric>
#include <random>

namespace sinew::volume_mesh_test {
namespace {

constexpr ElementKind kinds[] = {ElementKind::hexahedron8, ElementKind::hexahedron20,
                                 ElementKind::tetrahedron4, ElementKind::tetrahedron10};

/// One element, its corners those of a unit cube or at the ends of its edges.
VolumeMesh one(ElementKind kind) {
  VolumeMesh mesh;
  if (is_hexahedron(kind))
    mesh.nodes = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                  {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  else
    mesh.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  VolumeElement element;
  element.kind = is_hexahedron(kind) ? ElementKind::hexahedron8 : ElementKind::tetrahedron4;
  std::iota(element.nodes.begin(), element.nodes.end(), 0u);
  mesh.elements = {element};
  return nodes_of(kind) > corners_of(kind) ? second_order(mesh) : mesh;
}

Vec3 place(const VolumeMesh& mesh, const ShapeFunctions& at) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 0; k < mesh.elements[0].used().size(); ++k)
    sum += at.value[k] * mesh.nodes[mesh.elements[0].nodes[k]];
  return sum;
}

TEST(VolumeMesh, ShapeFunctionsAre1AtTheirNodeAnd0AtOthers) {
  for (const ElementKind kind : kinds) {
    const VolumeMesh mesh = one(kind);
    for (std::size_t node = 0; node < mesh.elements[0].used().size(); ++node) {
      const Vec3& at = mesh.nodes[node];
      const Vec3 local = is_hexahedron(kind) ? Vec3(2 * at - Vec3::Ones()) : at;
      const ShapeFunctions shape = shape_functions(kind, local);
      for (std::size_t k = 0; k < mesh.elements[0].used().size(); ++k)
        EXPECT_NEAR(shape.value[k], k == node ? 1 : 0, 1e-14) << nodes_of(kind);
    }
  }
}

TEST(VolumeMesh, ShapeFunctionsSumTo1AndTheirSlopesAreTheirDerivatives) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(0.05, 0.3);
  for (const ElementKind kind : kinds) {
    const VolumeMesh mesh = one(kind);
    const Vec3 local(any(random), any(random), any(random));
    const ShapeFunctions at = shape_functions(kind, local);
    EXPECT_NEAR(std::accumulate(at.value.begin(), at.value.end(), 0.0), 1, 1e-14);
    const Vec3 expected = is_hexahedron(kind) ? Vec3((local + Vec3::Ones()) / 2) : local;
    EXPECT_LT((place(mesh, at) - expected).norm(), 1e-14);
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 step = 1e-6 * Vec3::Unit(axis);
      const ShapeFunctions above = shape_functions(kind, local + step),
                           below = shape_functions(kind, local - step);
      for (std::size_t k = 0; k < mesh.elements[0].used().size(); ++k)
        EXPECT_NEAR(at.slope[k][axis], (above.value[k] - below.value[k]) / 2e-6, 1e-8);
    }
  }
}

/// Weights of a uniform force have its sum and its moment.
TEST(VolumeMesh, WeightsOfNodesActInTheMiddle) {
  for (const ElementKind kind : kinds) {
    const VolumeMesh mesh = one(kind);
    Vec3 middle = Vec3::Zero();
    double sum = 0;
    for (std::size_t k = 0; k < nodal_volume_weights(kind).size(); ++k)
      middle += nodal_volume_weights(kind)[k] * mesh.nodes[k], sum += nodal_volume_weights(kind)[k];
    EXPECT_NEAR(sum, 1, 1e-14);
    EXPECT_LT((middle - center_of(mesh, mesh.elements[0])).norm(), 1e-14);
    for (const ElementFace& face : boundary_faces(mesh)) {
      const auto nodes = face_nodes(mesh.elements[0], face.face);
      ASSERT_EQ(nodes.size(), nodal_face_weights(kind).size());
      Vec3 of_face = Vec3::Zero();
      for (std::size_t k = 0; k < nodes.size(); ++k)
        of_face += nodal_face_weights(kind)[k] * mesh.nodes[nodes[k]];
      EXPECT_LT((of_face - center_of(mesh, face)).norm(), 1e-14);
    }
  }
}

TEST(VolumeMesh, FacesOfABodyPointOutwardAndSumToZero) {
  for (const ElementKind kind : kinds) {
    const VolumeMesh mesh = one(kind);
    Vec3 sum = Vec3::Zero();
    double volume = 0;
    for (const ElementFace& face : boundary_faces(mesh)) {
      sum += area_vector(mesh, face);
      volume += area_vector(mesh, face).dot(center_of(mesh, face)) / 3;
    }
    EXPECT_LT(sum.norm(), 1e-14);
    EXPECT_NEAR(volume, volume_of(mesh, mesh.elements[0]), 1e-14);
  }
}

}  // namespace
}  // namespace sinew::volume_mesh_test

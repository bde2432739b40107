// SPDX-License-Identifier: GPL-3.0-or-later
// A body as finite elements: hexahedra and tetrahedra of the first and second order, their faces,
// and the shape functions of each.
//
//     const double volume = volume_of(mesh, element);
//     const ShapeFunctions at = shape_functions(element.kind, local);
//
// Nodes are numbered as in Abaqus and CalculiX: corners first, then the middles of edges.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <sinew/core/vector.h>

namespace sinew {

enum class ElementKind { hexahedron8, hexahedron20, tetrahedron4, tetrahedron10 };

inline constexpr int max_element_nodes = 20;

constexpr bool is_hexahedron(ElementKind kind) {
  return kind == ElementKind::hexahedron8 || kind == ElementKind::hexahedron20;
}
constexpr int corners_of(ElementKind kind) { return is_hexahedron(kind) ? 8 : 4; }
constexpr int nodes_of(ElementKind kind) {
  if (kind == ElementKind::hexahedron20) return 20;
  return kind == ElementKind::tetrahedron10 ? 10 : corners_of(kind);
}

struct VolumeElement {
  ElementKind kind = ElementKind::tetrahedron4;
  std::array<std::uint32_t, max_element_nodes> nodes = {};  ///< the first nodes_of(kind)

  std::span<const std::uint32_t> used() const {
    return {nodes.data(), static_cast<std::size_t>(nodes_of(kind))};
  }
};

struct VolumeMesh {
  Points nodes;  ///< m
  std::vector<VolumeElement> elements;
};

/// The edges of an element as pairs of corners; of second order, number k has node corners + k in
/// its middle.
std::span<const std::array<int, 2>> edges_of(ElementKind kind);

/// Adds to elements of first order the middles of their edges, halfway between the corners.
VolumeMesh second_order(VolumeMesh mesh);

/// The mean of its corners, m.
Vec3 center_of(const VolumeMesh& mesh, const VolumeElement& element);
/// Returns the volume of the flat-sided element on its corners, m^3; negative when inside out.
double volume_of(const VolumeMesh& mesh, const VolumeElement& element);

/// The weight of each node in a force that is uniform over an element's volume, exact for straight
/// edges and parallel sides; they sum to 1.
std::span<const double> nodal_volume_weights(ElementKind kind);

// Faces.

/// Number `face` of an element, from 0, in CalculiX's order.
struct ElementFace {
  std::uint32_t element = 0;
  int face = 0;
};

/// Corners first, then the middles of edges.
std::vector<std::uint32_t> face_nodes(const VolumeElement& element, int face);
/// The weight of each of face_nodes() in a force that is uniform over the face, exact for straight
/// edges and parallel sides; they sum to 1.
std::span<const double> nodal_face_weights(ElementKind kind);
/// Area times outward normal of the face on its corners, m^2.
Vec3 area_vector(const VolumeMesh& mesh, const ElementFace& face);
/// The mean of its corners, m.
Vec3 center_of(const VolumeMesh& mesh, const ElementFace& face);
/// The faces of one element alone, in the order of elements.
std::vector<ElementFace> boundary_faces(const VolumeMesh& mesh);

// Shape functions.

/// Shape function of each node, and its derivatives by the local coordinates.
struct ShapeFunctions {
  std::array<double, max_element_nodes> value = {};
  std::array<Vec3, max_element_nodes> slope = {};
};

/// Local coordinates lie from -1 to 1 in hexahedra; in tetrahedra they are three of the four that
/// sum to 1, each from 0 to 1, of the corners 1, 2 and 3.
ShapeFunctions shape_functions(ElementKind kind, const Vec3& local);

/// How far a place is outside of the element, over its size; 0 within.
double outside_by(ElementKind kind, const Vec3& local);

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// Where points lie in finite elements, and what a field on the nodes is there.
//
//     const std::vector<ElementPlace> places = places_in(mesh, particles);
//     const Vec3 moved = value_at(mesh, places[i], displacement);
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include <sinew/core/volume_mesh.h>

namespace sinew {

struct ElementPlace {
  std::uint32_t element = 0;
  std::array<double, max_element_nodes> weight = {};  ///< weights of its nodes; they sum to 1
  /// How far outside of the mesh, over the size of the nearest element; infinite: farther than one.
  double outside = std::numeric_limits<double>::infinity();
};

/// In parallel, the same bits for any number of threads. Points outside get the element that they
/// are least outside of, whose field goes on beyond its sides. Throws bad input for no elements.
std::vector<ElementPlace> places_in(const VolumeMesh& mesh, const Points& points);

/// The field's value, of any type that can be scaled and added, at a place.
template <class Value>
Value value_at(const VolumeMesh& mesh, const ElementPlace& place, const std::vector<Value>& field) {
  const auto nodes = mesh.elements[place.element].used();
  Value sum = place.weight[0] * field[nodes[0]];
  for (std::size_t k = 1; k < nodes.size(); ++k) sum += place.weight[k] * field[nodes[k]];
  return sum;
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/checks.h>

namespace sinew {
namespace {

void check_positions(const GltfAccessor& accessor, const std::string& user) {
  if (accessor.type != "VEC3" || accessor.number != GltfNumber::float32)
    throw bad_input(user + " are " + accessor.type + " of component type " +
                        std::to_string(static_cast<int>(accessor.number)) + ", not VEC3 of 5126",
                    "export positions as floats, without quantization");
}

void check_corners(const GltfAccessor& accessor, const std::string& user) {
  if (accessor.type != "SCALAR" || !counts(accessor.number) || accessor.normalized)
    throw damaged_gltf(user + " are not plain unsigned numbers");
  if (accessor.sparse) throw bad_input(user + " are sparse", "export without sparse accessors");
}

void check_count(GltfMode mode, std::int64_t corners, const std::string& user) {
  if (corners < 3 || (mode == GltfMode::triangles && corners % 3 != 0))
    throw damaged_gltf(user + " has " + std::to_string(corners) +
                       " corners, which make no triangles");
}

void check_surface(const GltfDocument& document, const GltfPrimitive& primitive,
                   const std::string& user) {
  const std::string positions = user + "'s positions", indices = user + "'s indices";
  const GltfAccessor* corners = &accessor_of(document, primitive.positions(), positions);
  check_positions(*corners, positions);
  if (primitive.indices >= 0) {
    corners = &accessor_of(document, primitive.indices, indices);
    check_corners(*corners, indices);
  }
  check_count(primitive.mode, corners->count, user);
}

void check_primitive(const GltfDocument& document, const GltfPrimitive& primitive,
                     const std::string& user) {
  if (primitive.indices >= 0) check_index(primitive.indices, document.accessors, user, "accessor");
  for (const auto& [name, index] : primitive.attributes)
    check_index(index, document.accessors, user, "accessor");
  if (primitive.is_surface()) check_surface(document, primitive, user);
}

}  // namespace

const GltfAccessor& accessor_of(const GltfDocument& document, int index, const std::string& user) {
  check_index(index, document.accessors, user, "accessor");
  const GltfAccessor& accessor = document.accessors[static_cast<std::size_t>(index)];
  if (accessor.view >= 0) return accessor;
  if (accessor.sparse)
    throw bad_input(user + " are sparse data over nothing", "export without sparse accessors");
  throw bad_input(user + " have no data", "export without mesh compression");
}

void check_gltf_meshes(const GltfDocument& document) {
  for (std::size_t i = 0; i < document.meshes.size(); ++i) {
    const auto& primitives = document.meshes[i].primitives;
    for (std::size_t k = 0; k < primitives.size(); ++k)
      check_primitive(document, primitives[k], nth("meshes", i) + '.' + nth("primitives", k));
  }
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include <sinew/io/gltf/checks.h>

namespace sinew {
namespace {

void check_joints(const GltfDocument& document, const GltfSkin& skin, const std::string& user) {
  if (skin.joints.empty()) throw damaged_gltf(user + " has no joints");
  for (const int joint : skin.joints) check_index(joint, document.nodes, user, "node");
  if (skin.root >= 0) check_index(skin.root, document.nodes, user, "node");
  std::vector<int> sorted = skin.joints;
  std::sort(sorted.begin(), sorted.end());
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  if (twice != sorted.end())
    throw damaged_gltf(user + " names node " + std::to_string(*twice) + " twice");
}

void check_binds(const GltfDocument& document, const GltfSkin& skin, const std::string& user) {
  if (skin.binds < 0) return;
  const GltfAccessor& binds = accessor_of(document, skin.binds, user + "'s inverse bind matrices");
  if (binds.type != "MAT4" || binds.number != GltfNumber::float32)
    throw damaged_gltf(user + "'s inverse bind matrices are not MAT4 of 5126");
  if (binds.count < static_cast<std::int64_t>(skin.joints.size()))
    throw damaged_gltf(user + " has " + std::to_string(binds.count) +
                       " inverse bind matrices for " + std::to_string(skin.joints.size()) +
                       " joints");
}

bool is_short(GltfNumber number) {
  return number == GltfNumber::uint8 || number == GltfNumber::uint16;
}

/// Four for each vertex, as joints or as weights.
void check_influences(const GltfDocument& document, const GltfPrimitive& primitive, int index,
                      bool weights, const std::string& user) {
  const GltfAccessor& accessor = accessor_of(document, index, user);
  const bool number = weights ? accessor.number == GltfNumber::float32 ||
                                    (is_short(accessor.number) && accessor.normalized)
                              : is_short(accessor.number) && !accessor.normalized;
  if (accessor.type != "VEC4" || !number)
    throw damaged_gltf(user + " are " + accessor.type + " of component type " +
                       std::to_string(static_cast<int>(accessor.number)));
  const auto vertices = accessor_of(document, primitive.positions(), user).count;
  if (accessor.count != vertices)
    throw damaged_gltf(user + " are " + std::to_string(accessor.count) + " for " +
                       std::to_string(vertices) + " vertices");
}

void check_sets(const GltfDocument& document, const GltfPrimitive& primitive,
                const std::string& user) {
  for (const auto& [name, index] : primitive.attributes) {
    const bool joints = name.starts_with("JOINTS_"), weights = name.starts_with("WEIGHTS_");
    if (!joints && !weights) continue;
    const std::string other = (joints ? "WEIGHTS" : "JOINTS") + name.substr(name.find('_'));
    if (!primitive.attributes.contains(other))
      throw damaged_gltf(user + " has JOINTS or WEIGHTS without the other");
    check_influences(document, primitive, index, weights,
                     user + (weights ? "'s weights" : "'s joints"));
  }
}

}  // namespace

void check_gltf_skins(const GltfDocument& document) {
  for (std::size_t i = 0; i < document.skins.size(); ++i) {
    check_joints(document, document.skins[i], nth("skins", i));
    check_binds(document, document.skins[i], nth("skins", i));
  }
  for (std::size_t i = 0; i < document.meshes.size(); ++i) {
    const auto& primitives = document.meshes[i].primitives;
    for (std::size_t k = 0; k < primitives.size(); ++k)
      if (primitives[k].is_surface())
        check_sets(document, primitives[k], nth("meshes", i) + '.' + nth("primitives", k));
  }
}

}  // namespace sinew

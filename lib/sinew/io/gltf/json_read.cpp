// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <utility>

#include <sinew/core/text.h>
#include <sinew/io/gltf/checks.h>
#include <sinew/io/gltf/field.h>
#include <sinew/io/gltf/json.h>

namespace sinew {
namespace {

using Field = GltfField;

GltfBuffer buffer_in(const Field& field) {
  const Field uri = field["uri"];
  return {field["byteLength"].whole(1), uri.given() ? std::optional(uri.text()) : std::nullopt};
}

GltfView view_in(const Field& field) {
  const Field stride = field["byteStride"];
  return {field["buffer"].index(), field["byteOffset"].whole_or(0), field["byteLength"].whole(1),
          stride.given() ? stride.whole(4, 252) : 0};
}

GltfNumber number_in(const Field& field) {
  constexpr int signed_int32 = 5124;  // OpenGL has it, glTF does not
  const std::int64_t number = field.whole(5120, 5126);
  if (number == signed_int32) throw damaged_gltf(field.name() + " is 5124");
  return static_cast<GltfNumber>(number);
}

GltfSparse sparse_in(const Field& field) {
  const Field indices = field["indices"], values = field["values"];
  GltfSparse sparse;
  sparse.count = field["count"].whole(1);
  sparse.index_view = indices["bufferView"].index();
  sparse.index_offset = indices["byteOffset"].whole_or(0);
  sparse.index_number = number_in(indices["componentType"]);
  sparse.value_view = values["bufferView"].index();
  sparse.value_offset = values["byteOffset"].whole_or(0);
  return sparse;
}

GltfAccessor accessor_in(const Field& field) {
  GltfAccessor accessor;
  accessor.view = field["bufferView"].index_or_none();
  accessor.offset = field["byteOffset"].whole_or(0);
  accessor.count = field["count"].whole(1);
  accessor.number = number_in(field["componentType"]);
  accessor.type = field["type"].text();
  if (components_of(accessor.type) == 0)
    throw damaged_gltf(field["type"].name() + " is " + shown(accessor.type));
  accessor.normalized = field["normalized"].flag();
  if (const Field sparse = field["sparse"]; sparse.given()) accessor.sparse = sparse_in(sparse);
  return accessor;
}

GltfPrimitive primitive_in(const Field& field) {
  const Field mode = field["mode"];
  return {mode.given() ? static_cast<GltfMode>(mode.whole(0, 6)) : GltfMode::triangles,
          field["indices"].index_or_none(), field["attributes"].named_indices()};
}

GltfMesh mesh_in(const Field& field) {
  GltfMesh mesh{field.given_name(), {}};
  for (const Field& primitive : field["primitives"].items())
    mesh.primitives.push_back(primitive_in(primitive));
  return mesh;
}

std::vector<double> rotation_in(const Field& field) {
  std::vector<double> rotation = field.numbers(4);
  double square = 0;
  for (const double part : rotation) square += part * part;
  if (field.given() && !(square > 0)) throw damaged_gltf(field.name() + " is of length 0");
  for (double& part : rotation) part /= std::sqrt(square);
  return rotation;
}

GltfNode node_in(const Field& field) {
  GltfNode node;
  node.name = field.given_name();
  node.children = field["children"].indices();
  node.mesh = field["mesh"].index_or_none();
  node.skin = field["skin"].index_or_none();
  node.matrix = field["matrix"].numbers(16);
  node.translation = field["translation"].numbers(3);
  node.rotation = rotation_in(field["rotation"]);
  node.scale = field["scale"].numbers(3);
  if (field["extensions"]["EXT_mesh_gpu_instancing"].given())
    throw bad_input(field.name() + " repeats its mesh by EXT_mesh_gpu_instancing",
                    "export without instancing");
  return node;
}

GltfSkin skin_in(const Field& field) {
  return {field["joints"].indices(), field["inverseBindMatrices"].index_or_none(),
          field["skeleton"].index_or_none()};
}

/// The value that a word of the list stands for.
template <class Value>
Value word_in(const Field& field, std::initializer_list<std::pair<const char*, Value>> words) {
  const std::string text = field.text();
  const auto* found = std::find_if(words.begin(), words.end(),
                                   [&](const auto& word) { return word.first == text; });
  if (found == words.end()) throw damaged_gltf(field.name() + " is " + shown(text));
  return found->second;
}

GltfSampler sampler_in(const Field& field) {
  GltfSampler sampler{field["input"].index(), field["output"].index()};
  if (const Field kind = field["interpolation"]; kind.given())
    sampler.interpolation =
        word_in<GltfInterpolation>(kind, {{"STEP", GltfInterpolation::step},
                                          {"LINEAR", GltfInterpolation::linear},
                                          {"CUBICSPLINE", GltfInterpolation::cubic}});
  return sampler;
}

/// Weights are those of morph targets, pointers lead to things that are no nodes.
GltfChannel channel_in(const Field& field) {
  const Field target = field["target"];
  const GltfPath path = word_in<GltfPath>(target["path"], {{"translation", GltfPath::translation},
                                                           {"rotation", GltfPath::rotation},
                                                           {"scale", GltfPath::scale},
                                                           {"weights", GltfPath::other},
                                                           {"pointer", GltfPath::other}});
  return {field["sampler"].index(), target["node"].index_or_none(), path};
}

template <class Element>
std::vector<Element> all(const Field& field, Element (*one)(const Field&)) {
  std::vector<Element> elements;
  for (const Field& item : field.items()) elements.push_back(one(item));
  return elements;
}

GltfAnimation animation_in(const Field& field) {
  return {field.given_name(), all(field["samplers"], sampler_in),
          all(field["channels"], channel_in)};
}

}  // namespace

GltfDocument gltf_document(std::string_view json) {
  const Field root(json);
  const Field asset = root["asset"];
  GltfDocument document;
  document.version = asset["version"].text();
  document.least_version = asset["minVersion"].text_or_none();
  document.extensions_required = root["extensionsRequired"].texts();
  document.buffers = all(root["buffers"], buffer_in);
  document.views = all(root["bufferViews"], view_in);
  document.accessors = all(root["accessors"], accessor_in);
  document.meshes = all(root["meshes"], mesh_in);
  document.nodes = all(root["nodes"], node_in);
  document.skins = all(root["skins"], skin_in);
  document.animations = all(root["animations"], animation_in);
  for (const Field& scene : root["scenes"].items())
    document.scenes.push_back(scene["nodes"].indices());
  document.scene = root["scene"].index_or_none();
  return document;
}

}  // namespace sinew

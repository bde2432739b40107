// SPDX-License-Identifier: GPL-3.0-or-later
#include <nlohmann/json.hpp>

#include <sinew/io/gltf/json.h>

namespace sinew {
namespace {

using Json = nlohmann::json;

template <class Element>
Json written(const std::vector<Element>& elements);

Json written(const GltfView& view) {
  Json json = {{"buffer", 0}, {"byteOffset", view.offset}, {"byteLength", view.size}};
  if (view.stride > 0) json["byteStride"] = view.stride;
  return json;
}

Json written(const GltfSparse& sparse) {
  const Json indices = {{"bufferView", sparse.index_view},
                        {"byteOffset", sparse.index_offset},
                        {"componentType", sparse.index_number}};
  const Json values = {{"bufferView", sparse.value_view}, {"byteOffset", sparse.value_offset}};
  return {{"count", sparse.count}, {"indices", indices}, {"values", values}};
}

Json written(const GltfAccessor& accessor) {
  Json json = {{"byteOffset", accessor.offset},
               {"count", accessor.count},
               {"componentType", accessor.number},
               {"type", accessor.type}};
  if (accessor.view >= 0) json["bufferView"] = accessor.view;
  // VTK would divide floats by the largest float.
  if (accessor.normalized && accessor.number != GltfNumber::float32) json["normalized"] = true;
  if (accessor.sparse) json["sparse"] = written(*accessor.sparse);
  return json;
}

Json written(const GltfPrimitive& primitive) {
  Json json = {{"mode", primitive.mode}, {"attributes", {{"POSITION", primitive.positions()}}}};
  if (primitive.indices >= 0) json["indices"] = primitive.indices;
  return json;
}

Json written(const GltfNode& node) {
  Json json = Json::object();
  if (node.mesh >= 0) json["mesh"] = node.mesh;
  const auto put = [&](const char* key, const auto& numbers) {
    if (!numbers.empty()) json[key] = numbers;
  };
  put("children", node.children);
  put("matrix", node.matrix);
  put("translation", node.translation);
  put("rotation", node.rotation);
  put("scale", node.scale);
  return json;
}

Json written(const GltfMesh& mesh) { return {{"primitives", written(mesh.primitives)}}; }

template <class Element>
Json written(const std::vector<Element>& elements) {
  Json json = Json::array();
  for (const Element& element : elements) json.push_back(written(element));
  return json;
}

}  // namespace

std::string gltf_json(const GltfDocument& document, std::int64_t bytes) {
  Json scenes = Json::array();
  for (const auto& nodes : document.scenes) scenes.push_back({{"nodes", nodes}});
  const Json json = {{"asset", {{"version", "2.0"}}},
                     {"buffers", Json::array({{{"byteLength", bytes}}})},
                     {"bufferViews", written(document.views)},
                     {"accessors", written(document.accessors)},
                     {"meshes", written(document.meshes)},
                     {"nodes", written(document.nodes)},
                     {"scenes", scenes},
                     {"scene", document.scene}};
  return json.dump();
}

}  // namespace sinew

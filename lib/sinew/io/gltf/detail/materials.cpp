// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/detail/materials.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include <sinew/core/base64.h>
#include <sinew/core/file.h>
#include <sinew/core/json.h>
#include <sinew/io/gltf/converted.h>
#include <sinew/io/gltf/detail/container.h>

namespace sinew {
namespace {

using OrderedJson = nlohmann::ordered_json;

/// The text of an object's key; none where it has no such text.
std::optional<std::string> text_of(const OrderedJson& object, const char* key) {
  if (!object.is_object() || !object.contains(key) || !object[key].is_string()) return {};
  return object[key].get<std::string>();
}

std::optional<std::string> bytes_of_view(const OrderedJson& image, const CheckedGltf& gltf) {
  if (!image["bufferView"].is_number_unsigned()) return {};
  const auto index = image["bufferView"].get<std::size_t>();
  if (index >= gltf.document.views.size()) return {};
  const GltfView& view = gltf.document.views[index];
  return std::string(gltf.bytes.data() + view.offset, static_cast<std::size_t>(view.size));
}

std::optional<std::string> decoded(std::string_view uri) {
  const std::size_t comma = uri.find(',');
  if (comma == uri.npos || !uri.substr(0, comma).ends_with(";base64")) return {};
  const std::string_view digits = uri.substr(comma + 1);
  std::string bytes(bytes_in_base64(digits), '\0');
  if (!from_base64(digits, bytes.size(), reinterpret_cast<unsigned char*>(bytes.data()))) return {};
  return bytes;
}

/// The bytes of an image, where they can be read.
std::optional<std::string> bytes_of(const OrderedJson& image, const std::filesystem::path& folder,
                                    const CheckedGltf& gltf) {
  if (!image.is_object()) return {};
  if (image.contains("bufferView")) return bytes_of_view(image, gltf);
  const auto uri = text_of(image, "uri");
  if (!uri) return {};
  if (uri->starts_with("data:")) return decoded(*uri);
  try {
    const std::filesystem::path file = gltf_file_of(*uri, folder);
    return read_file(file_below(folder, file.lexically_relative(folder / "")));
  } catch (const Error&) {
    return {};
  }
}

/// Moves the bytes of the images out of the JSON.
void take_images(OrderedJson& json, const std::filesystem::path& folder, const CheckedGltf& gltf,
                 std::vector<std::string>& images) {
  if (!json.contains("images")) return;
  for (OrderedJson& image : json["images"]) {
    auto bytes = bytes_of(image, folder, gltf);
    const char* type = bytes ? gltf_image_type(*bytes) : nullptr;
    if (!type) {
      if (image.is_object() && image.contains("bufferView")) image = {{"uri", "data:,"}};
      continue;
    }
    image.erase("uri");
    image["mimeType"] = type;
    image["bufferView"] = images.size();
    images.push_back(*std::move(bytes));
  }
}

/// Picks the extensions that say how surfaces look.
OrderedJson extensions_of_looks(const OrderedJson& used) {
  OrderedJson kept = OrderedJson::array();
  for (const OrderedJson& name : used) {
    if (!name.is_string()) continue;
    const auto text = name.get<std::string>();
    if (text.find("_materials_") != text.npos || text.find("_texture_") != text.npos)
      kept.push_back(text);
  }
  return kept;
}

/// The number of a texture that shows this file; none where it is no image that glTF allows.
std::optional<int> add_texture(OrderedJson& json, std::vector<std::string>& images,
                               const std::filesystem::path& file) {
  std::string bytes;
  try {
    bytes = read_file(file);
  } catch (const Error&) {
    return {};
  }
  const std::string_view type = gltf_image_type(bytes) ? gltf_image_type(bytes) : "";
  if (type != "image/png" && type != "image/jpeg") return {};
  json["images"].push_back(
      {{"name", file.stem().string()}, {"mimeType", type}, {"bufferView", images.size()}});
  json["textures"].push_back({{"source", json["images"].size() - 1}});
  images.push_back(std::move(bytes));
  return static_cast<int>(json["textures"].size()) - 1;
}

}  // namespace

const char* gltf_image_type(std::string_view bytes) {
  if (bytes.starts_with("\x89PNG")) return "image/png";
  if (bytes.starts_with("\xff\xd8")) return "image/jpeg";
  if (bytes.starts_with("\xabKTX 20")) return "image/ktx2";
  if (bytes.starts_with("RIFF") && bytes.substr(0, 12).ends_with("WEBP")) return "image/webp";
  return nullptr;
}

int add_material(GltfMaterials& materials, const SurfaceLook::Material& material) {
  OrderedJson json =
      materials.json.empty() ? OrderedJson::object() : parsed_json<OrderedJson>(materials.json);
  const auto& [red, green, blue] = material.color;
  OrderedJson surface = {{"baseColorFactor", {red, green, blue, material.opacity}},
                         {"metallicFactor", 0}};
  if (!material.image.empty())
    if (const auto texture = add_texture(json, materials.images, material.image))
      surface["baseColorTexture"] = {{"index", *texture}};
  OrderedJson added = {{"name", material.name}, {"pbrMetallicRoughness", surface}};
  if (material.opacity < 1) added["alphaMode"] = "BLEND";
  json["materials"].push_back(std::move(added));
  materials.json = json_text(json);
  return static_cast<int>(json["materials"].size()) - 1;
}

GltfMaterials gltf_materials(const std::filesystem::path& path, const CheckedGltf& gltf) {
  const std::filesystem::path source = gltf_of(path);
  const GltfContainer container = gltf_container(read_gltf_file(source), source.extension());
  const OrderedJson file = parsed_json<OrderedJson>(container.json);
  if (!file.is_object() || !file.contains("materials") || !file["materials"].is_array() ||
      file["materials"].empty())
    return {};
  OrderedJson json = OrderedJson::object();
  for (const char* key : {"materials", "textures", "samplers", "images"})
    if (file.contains(key) && file[key].is_array() && !file[key].empty()) json[key] = file[key];
  if (file.contains("extensionsUsed"))
    if (OrderedJson kept = extensions_of_looks(file["extensionsUsed"]); !kept.empty())
      json["extensionsUsed"] = std::move(kept);
  GltfMaterials materials;
  take_images(json, source.parent_path(), gltf, materials.images);
  materials.json = json_text(json);
  return materials;
}

std::vector<std::string> names_of(const GltfMaterials& materials) {
  if (materials.json.empty()) return {};
  std::vector<std::string> names;
  const OrderedJson json = parsed_json<OrderedJson>(materials.json);
  for (const OrderedJson& material : json["materials"]) {
    std::string name = text_of(material, "name").value_or("");
    if (name.empty()) name = "material_" + std::to_string(names.size());
    const auto unprintable = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
    std::replace_if(name.begin(), name.end(), unprintable, '?');
    names.push_back(std::move(name));
  }
  return names;
}

}  // namespace sinew

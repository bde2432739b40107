// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/document.h>

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include <sinew/core/json.h>
#include <sinew/core/text.h>

namespace sinew {
namespace {

using Json = nlohmann::json;

constexpr int deepest_nesting = 100;      // real files are nested to about 10
constexpr std::int64_t max_values = 4e6;  // each takes about 100 bytes once parsed
constexpr std::size_t max_items = 100'000;

/// Checked before parsing: deeply nested values are later copied and freed by recursion.
void check_extent(std::string_view json) {
  const JsonExtent extent = json_extent(json);
  if (extent.depth > deepest_nesting) throw damaged_gltf("its JSON is nested more than 100 deep");
  if (extent.values > max_values) throw damaged_gltf("its JSON holds more than 4 million values");
}

Json parsed(std::string_view text) {
  check_extent(text);
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    throw damaged_gltf("its JSON is damaged at byte " + std::to_string(error.byte));
  } catch (const Json::out_of_range&) {
    throw damaged_gltf("its JSON holds a number that is too large");
  }
}

/// The integer that a JSON number represents: 100 may be written 1e2.
std::optional<std::int64_t> integer_in(const Json& value) {
  constexpr double max_exact = 9007199254740992;  // 2^53
  if (value.is_number_unsigned() && value.get<std::uint64_t>() > INT64_MAX) return std::nullopt;
  if (value.is_number_integer()) return value.get<std::int64_t>();
  if (!value.is_number_float()) return std::nullopt;
  const double number = value.get<double>();
  if (std::abs(number) > max_exact || number != std::floor(number)) return std::nullopt;
  return static_cast<std::int64_t>(number);
}

Error wrong(const std::string& name, const Json& value, const std::string& wanted) {
  const std::string what =
      value.is_primitive() ? shown(json_text(value)) : std::string("an ") + value.type_name();
  return damaged_gltf((name.empty() ? "its JSON" : name) + " is " + what + ", not " + wanted);
}

std::int64_t whole_in(const Json& value, const std::string& name, std::int64_t least,
                      std::int64_t most) {
  const auto number = integer_in(value);
  if (!number || *number < least || *number > most)
    throw wrong(name, value,
                "a whole number between " + std::to_string(least) + " and " + std::to_string(most));
  return *number;
}

int index_in(const Json& value, const std::string& name) {
  return static_cast<int>(whole_in(value, name, 0, max_gltf_bytes));
}

double number_in(const Json& value, const std::string& name) {
  if (!value.is_number()) throw wrong(name, value, "a number");
  const double number = value.get<double>();
  if (!(std::abs(number) <= FLT_MAX))
    throw damaged_gltf(name + " holds " + shown(json_text(value)) + ", too large for a float");
  return number;
}

/// A value, possibly missing, and its name in messages: "accessors[3].count". Every function throws
/// bad input for a value of another type. Missing numbers and texts are refused as well; missing
/// lists are empty.
class Field {
 public:
  explicit Field(const Json& root) : value_(&root) {}

  bool given() const { return value_ != nullptr; }
  const std::string& name() const { return name_; }

  Field operator[](const char* key) const {  ///< member of an object
    const std::string name = name_.empty() ? key : name_ + '.' + key;
    if (!given()) return {nullptr, name};
    const auto found = object().find(key);
    return {found == value_->end() ? nullptr : &*found, name};
  }

  std::vector<Field> items() const {  ///< elements of an array
    std::vector<Field> items;
    if (array().size() > max_items)
      throw bad_input(
          name_ + " lists " + std::to_string(array().size()) + " items, more than 100000",
          "export only what is needed");
    for (const Json& item : array()) items.push_back({&item, nth(name_, items.size())});
    return items;
  }

  std::vector<Field> members() const {  ///< values of an object
    std::vector<Field> members;
    if (!given()) return members;
    for (const auto& [key, value] : object().items())
      members.push_back({&value, name_ + '.' + shown(key)});
    return members;
  }

  std::int64_t whole(std::int64_t least, std::int64_t most = max_gltf_bytes) const {
    return whole_in(given_value(), name_, least, most);
  }
  std::int64_t whole_or(std::int64_t other) const { return given() ? whole(0) : other; }
  int index() const { return static_cast<int>(whole(0)); }
  int index_or_none() const { return given() ? index() : -1; }

  std::vector<int> indices() const {
    std::vector<int> indices;
    for (const Json& item : array()) indices.push_back(index_in(item, name_));
    return indices;
  }

  std::map<std::string, int> named_indices() const {  ///< an object's
    std::map<std::string, int> named;
    if (!given()) return named;
    for (const auto& [key, value] : object().items())
      named[key] = index_in(value, name_ + '.' + shown(key));
    return named;
  }

  /// Numbers that fit single precision.
  std::vector<double> numbers() const {
    std::vector<double> numbers;
    for (const Json& item : array()) numbers.push_back(number_in(item, name_));
    return numbers;
  }
  std::vector<double> numbers(std::size_t count) const {  ///< so many, or none
    std::vector<double> numbers = this->numbers();
    if (given() && numbers.size() != count)
      throw damaged_gltf(name_ + " holds " + std::to_string(numbers.size()) + " numbers, not " +
                         std::to_string(count));
    return numbers;
  }

  std::string text() const {
    if (!given_value().is_string()) throw wrong(name_, *value_, "text");
    return value_->get<std::string>();
  }
  std::string text_or_none() const { return given() ? text() : std::string(); }

  /// Returns the name of an object, or "". Characters that cannot be printed in a line become '?'.
  std::string given_name() const {
    std::string name = (*this)["name"].text_or_none();
    const auto unprintable = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
    std::replace_if(name.begin(), name.end(), unprintable, '?');
    return name;
  }

  bool flag() const {  ///< false where it is missing
    if (given() && !value_->is_boolean()) throw wrong(name_, *value_, "true or false");
    return given() && value_->get<bool>();
  }

 private:
  Field(const Json* value, std::string name) : value_(value), name_(std::move(name)) {}

  const Json& given_value() const {
    if (!given()) throw damaged_gltf(name_ + " is missing");
    return *value_;
  }
  const Json& object() const {
    if (!value_->is_object()) throw wrong(name_, *value_, "an object");
    return *value_;
  }
  const Json& array() const {
    static const Json none = Json::array();
    if (given() && !value_->is_array()) throw wrong(name_, *value_, "an array");
    return given() ? *value_ : none;
  }

  const Json* value_;  // a part of the parser's tree
  std::string name_;
};

std::string text_in(const Field& field) { return field.text(); }

GltfBuffer buffer_in(const Field& field) {
  const Field uri = field["uri"];
  return {field["byteLength"].whole(1), uri.given() ? std::optional(uri.text()) : std::nullopt,
          field["extensions"]["EXT_meshopt_compression"]["fallback"].flag()};
}

GltfView view_in(const Field& field) {
  const Field stride = field["byteStride"];
  GltfView view{field["buffer"].index(), field["byteOffset"].whole_or(0),
                field["byteLength"].whole(1), stride.given() ? stride.whole(4, 252) : 0};
  if (const Field packed = field["extensions"]["EXT_meshopt_compression"]; packed.given())
    view.packed = {packed["buffer"].index(),       packed["byteOffset"].whole_or(0),
                   packed["byteLength"].whole(1),  packed["byteStride"].whole(1, 256),
                   packed["count"].whole(1),       packed["mode"].text(),
                   packed["filter"].text_or_none()};
  return view;
}

GltfNumber kind_in(const Field& field) {
  constexpr int signed_int32 = 5124;  // in OpenGL, not in glTF
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
  sparse.index_number = kind_in(indices["componentType"]);
  sparse.value_view = values["bufferView"].index();
  sparse.value_offset = values["byteOffset"].whole_or(0);
  return sparse;
}

GltfAccessor accessor_in(const Field& field) {
  GltfAccessor accessor;
  accessor.view = field["bufferView"].index_or_none();
  accessor.offset = field["byteOffset"].whole_or(0);
  accessor.count = field["count"].whole(1);
  accessor.number = kind_in(field["componentType"]);
  accessor.type = field["type"].text();
  if (components_of(accessor.type) == 0)
    throw damaged_gltf(field["type"].name() + " is " + shown(accessor.type));
  accessor.normalized = field["normalized"].flag();
  if (const Field sparse = field["sparse"]; sparse.given()) accessor.sparse = sparse_in(sparse);
  return accessor;
}

GltfPrimitive primitive_in(const Field& field) {
  const Field mode = field["mode"];
  GltfPrimitive primitive{
      mode.given() ? static_cast<GltfMode>(mode.whole(0, 6)) : GltfMode::triangles,
      field["indices"].index_or_none(),
      field["material"].index_or_none(),
      field["attributes"].named_indices(),
      -1,
      {},
      {}};
  if (const Field draco = field["extensions"]["KHR_draco_mesh_compression"]; draco.given()) {
    primitive.draco = draco["bufferView"].index();
    primitive.draco_attributes = draco["attributes"].named_indices();
  }
  for (const Field& target : field["targets"].items())
    primitive.targets.push_back(target["POSITION"].index_or_none());
  return primitive;
}

GltfMesh mesh_in(const Field& field) {
  GltfMesh mesh{field.given_name(), {}, field["weights"].numbers()};
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
  node.weights = field["weights"].numbers();
  if (field["extensions"]["EXT_mesh_gpu_instancing"].given())
    throw bad_input(field.name() + " repeats its mesh by EXT_mesh_gpu_instancing",
                    "export without instancing");
  return node;
}

GltfSkin skin_in(const Field& field) {
  return {field["joints"].indices(), field["inverseBindMatrices"].index_or_none(),
          field["skeleton"].index_or_none()};
}

/// The value of a word in the list.
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

/// Pointers refer to other things than nodes.
GltfChannel channel_in(const Field& field) {
  const Field target = field["target"];
  const GltfPath path = word_in<GltfPath>(target["path"], {{"translation", GltfPath::translation},
                                                           {"rotation", GltfPath::rotation},
                                                           {"scale", GltfPath::scale},
                                                           {"weights", GltfPath::weights},
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

int size_of(GltfNumber number) {
  switch (number) {
    case GltfNumber::int8:
    case GltfNumber::uint8:
      return 1;
    case GltfNumber::int16:
    case GltfNumber::uint16:
      return 2;
    default:
      return 4;
  }
}

int components_of(std::string_view type) {
  constexpr std::array<std::pair<std::string_view, int>, 7> types = {{{"SCALAR", 1},
                                                                      {"VEC2", 2},
                                                                      {"VEC3", 3},
                                                                      {"VEC4", 4},
                                                                      {"MAT2", 4},
                                                                      {"MAT3", 9},
                                                                      {"MAT4", 16}}};
  const auto* found = std::find_if(types.begin(), types.end(),
                                   [&](const auto& known) { return known.first == type; });
  return found == types.end() ? 0 : found->second;
}

namespace {

/// VRM 0.x has a list, 1.0 an object.
std::vector<int> humanoid_of(const Field& extensions) {
  std::vector<int> nodes;
  for (const Field& bone : extensions["VRM"]["humanoid"]["humanBones"].items())
    nodes.push_back(bone["node"].index_or_none());
  for (const Field& bone : extensions["VRMC_vrm"]["humanoid"]["humanBones"].members())
    nodes.push_back(bone["node"].index_or_none());
  return nodes;
}

}  // namespace

GltfDocument gltf_document(std::string_view json) {
  const Json parsed_json = parsed(json);
  const Field root(parsed_json);
  const Field asset = root["asset"];
  GltfDocument document;
  document.version = asset["version"].text();
  document.min_version = asset["minVersion"].text_or_none();
  document.extensions_required = all(root["extensionsRequired"], text_in);
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
  document.humanoid = humanoid_of(root["extensions"]);
  return document;
}

}  // namespace sinew

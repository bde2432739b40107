// SPDX-License-Identifier: GPL-3.0-or-later
// Binary formats in single precision: Houdini's classic BGEO, version 5, as Partio reads it, and
// glTF points in a GLB.
#include <bit>
#include <nlohmann/json.hpp>

#include <sinew/core/json.h>
#include <sinew/core/triangles.h>
#include <sinew/io/particle_formats/detail/writers.h>

namespace sinew {
namespace {

using OrderedJson = nlohmann::ordered_json;

enum class ByteOrder { little, big };

template <ByteOrder order, class Word>
void put_bytes(std::string& bytes, Word word) requires std::is_unsigned_v<Word> {
  for (std::size_t k = 0; k < sizeof word; ++k) {
    const std::size_t byte = order == ByteOrder::little ? k : sizeof word - 1 - k;
    bytes += static_cast<char>(word >> (8 * byte) & 0xff);
  }
}

template <ByteOrder order>
void put_float(std::string& bytes, double value) {
  put_bytes<order>(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(value)));
}

template <ByteOrder order>
void put_floats(std::string& bytes, const Vec3& v) {
  for (int axis = 0; axis < 3; ++axis) put_float<order>(bytes, v[axis]);
}

constexpr auto big = ByteOrder::big;
constexpr auto little = ByteOrder::little;

enum class BgeoType : std::uint32_t { real = 0, integer = 1, vector = 5 };

/// An attribute of the points; its default is 0.
void put_attribute(std::string& bytes, std::string_view name, BgeoType type, std::uint16_t size) {
  put_bytes<big>(bytes, static_cast<std::uint16_t>(name.size()));
  bytes += name;
  put_bytes<big>(bytes, size);
  put_bytes<big>(bytes, static_cast<std::uint32_t>(type));
  bytes.append(4 * std::size_t{size}, '\0');
}

std::string bgeo_head(const ParticleCloud& cloud) {
  const bool moves = !cloud.velocities.empty(), is_far = !cloud.origin.isZero(0);
  std::string head = "BgeoV";
  for (const std::size_t word : {std::size_t{5}, cloud.positions.size()})
    put_bytes<big>(head, static_cast<std::uint32_t>(word));
  for (const std::uint32_t word : {0u, 0u, 0u, 5u + moves + is_far, 0u, 0u, 0u})
    put_bytes<big>(head, word);  // primitives, groups of both, attributes of points and others
  put_attribute(head, "id", BgeoType::integer, 1);
  put_attribute(head, "pscale", BgeoType::real, 1);
  put_attribute(head, "mass", BgeoType::real, 1);
  put_attribute(head, "component", BgeoType::integer, 1);
  put_attribute(head, "region", BgeoType::integer, 1);
  if (moves) put_attribute(head, "velocity", BgeoType::vector, 3);
  if (is_far) put_attribute(head, "origin", BgeoType::real, 3);  // Houdini turns vectors
  return head;
}

/// Turns x forward and z up to z forward and y up: x y z becomes y z x.
Vec3 turned(const Vec3& p) { return {p.y(), p.z(), p.x()}; }

OrderedJson list(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

OrderedJson only(OrderedJson item) {
  OrderedJson list = OrderedJson::array();
  list.push_back(std::move(item));
  return list;
}

/// Rounds as the file does. Volatile, since g++ 12 at -O2 drops two neighboring conversions to
/// float and back as if they changed nothing.
double rounded(double value) {
  const volatile float single = static_cast<float>(value);
  return single;
}

Vec3 rounded(const Vec3& v) { return {rounded(v.x()), rounded(v.y()), rounded(v.z())}; }

std::string gltf_json(const ParticleCloud& cloud, const Box& box, const Vec3& center) {
  const std::size_t bytes = 12 * cloud.positions.size();
  const OrderedJson accessor = {{"bufferView", 0},
                                {"componentType", 5126},
                                {"count", cloud.positions.size()},
                                {"type", "VEC3"},
                                {"min", list(rounded(turned(box.min() - center)))},
                                {"max", list(rounded(turned(box.max() - center)))}};
  OrderedJson json = {{"asset", {{"version", "2.0"}, {"generator", "sinew"}}}, {"scene", 0}};
  json["scenes"] = only({{"nodes", only(0)}});
  json["nodes"] = only({{"name", "particles"}, {"mesh", 0}, {"translation", list(turned(center))}});
  json["meshes"] =
      only({{"primitives", only({{"attributes", {{"POSITION", 0}}}, {"mode", 0}})},
            {"extras", {{"radius", cloud.radius}, {"mass", cloud.mass}, {"time", cloud.time}}}});
  json["accessors"] = only(accessor);
  json["bufferViews"] = only({{"buffer", 0}, {"byteLength", bytes}, {"target", 34962}});
  json["buffers"] = only({{"byteLength", bytes}});
  std::string text = json_text(json);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  return text;
}

}  // namespace

void add_bgeo(NewFile& file, const ParticleCloud& cloud) {
  write_text(file, bgeo_head(cloud));
  write_rows(file, cloud.positions.size(), [&](std::string& bytes, std::size_t i) {
    put_floats<big>(bytes, cloud.positions[i] - cloud.origin);
    put_float<big>(bytes, 1);  // the fourth, homogeneous coordinate
    put_bytes<big>(bytes, static_cast<std::uint32_t>(cloud.id[i]));
    put_float<big>(bytes, cloud.radius);
    put_float<big>(bytes, cloud.mass);
    put_bytes<big>(bytes, static_cast<std::uint32_t>(cloud.component[i]));
    put_bytes<big>(bytes, static_cast<std::uint32_t>(cloud.region[i]));
    if (!cloud.velocities.empty()) put_floats<big>(bytes, cloud.velocities[i]);
    if (!cloud.origin.isZero(0)) put_floats<big>(bytes, cloud.origin);
  });
  write_text(file, {'\0', '\xff'});
}

// Points are relative to the middle of the body, lest single precision round places far away.
void add_gltf_points(NewFile& file, const ParticleCloud& cloud) {
  const Box box = bounds(cloud.positions);
  const Vec3 center = box.center();
  const std::string json = gltf_json(cloud, box, center);
  const std::size_t bytes = 12 * cloud.positions.size();
  std::string head = "glTF";
  const auto put = [&](std::size_t word) {
    put_bytes<little>(head, static_cast<std::uint32_t>(word));
  };
  put(2), put(12 + 8 + json.size() + 8 + bytes);
  put(json.size()), head += "JSON" + json;
  put(bytes), head += std::string("BIN\0", 4);
  write_text(file, head);
  write_rows(file, cloud.positions.size(), [&](std::string& data, std::size_t i) {
    put_floats<little>(data, turned(cloud.positions[i] - center));
  });
}

}  // namespace sinew

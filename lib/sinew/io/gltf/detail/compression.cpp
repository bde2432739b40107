// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/detail/compression.h>

#include <cstring>
#include <limits>
#include <memory>
#include <string>

#include <sinew/core/text.h>

#ifdef SINEW_MESHOPT
#include <meshoptimizer.h>
#endif
#ifdef SINEW_DRACO
#include <draco/compression/decode.h>
#endif

namespace sinew {

const std::array<std::string_view, 2> gltf_codecs = {
#ifdef SINEW_MESHOPT
    "EXT_meshopt_compression",
#else
    "",
#endif
#ifdef SINEW_DRACO
    "KHR_draco_mesh_compression",
#else
    "",
#endif
};

namespace {

/// Room for so many bytes behind the others; returns where it begins, aligned to 4.
[[maybe_unused]] std::size_t room_for(std::int64_t size, CheckedGltf& gltf) {
  const std::size_t start = (gltf.bytes.size() + 3) / 4 * 4;
  if (size > max_gltf_bytes - static_cast<std::int64_t>(start))
    throw bad_input("it unpacks to more than 2147483647 bytes", "export it with fewer triangles");
  gltf.bytes.resize(start + static_cast<std::size_t>(size));
  return start;
}

#ifdef SINEW_MESHOPT

constexpr std::int64_t max_packing = 64;  // four bytes or more for a byte of each of 256 elements

bool is_sound(const GltfPacked& packed) {
  const std::int64_t stride = packed.stride;
  const bool index = stride == 2 || stride == 4;
  if (packed.mode == "TRIANGLES") return index && packed.count % 3 == 0 && packed.filter.empty();
  if (packed.mode == "INDICES") return index && packed.filter.empty();
  if (packed.mode != "ATTRIBUTES" || stride % 4 != 0) return false;
  if (packed.filter == "OCTAHEDRAL") return stride == 4 || stride == 8;
  if (packed.filter == "QUATERNION") return stride == 8;
  return packed.filter.empty() || packed.filter == "NONE" || packed.filter == "EXPONENTIAL";
}

void apply_filter(const GltfPacked& packed, void* data) {
  const auto count = static_cast<std::size_t>(packed.count),
             stride = static_cast<std::size_t>(packed.stride);
  if (packed.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(data, count, stride);
  if (packed.filter == "QUATERNION") meshopt_decodeFilterQuat(data, count, stride);
  if (packed.filter == "EXPONENTIAL") meshopt_decodeFilterExp(data, count, stride);
}

void unpack_view(CheckedGltf& gltf, std::size_t index) {
  GltfView& view = gltf.document.views[index];
  const GltfPacked packed = *view.packed;
  const std::string user = nth("bufferViews", index);
  if (!is_sound(packed)) throw damaged_gltf(user + " is packed in no way of meshopt");
  const std::int64_t size = packed.count * packed.stride;
  if (size != view.size || size / max_packing > packed.size)
    throw damaged_gltf(user + " has " + std::to_string(view.size) + " bytes, and unpacks to " +
                       std::to_string(size));
  const std::size_t start = room_for(size, gltf);
  const auto* from = reinterpret_cast<const unsigned char*>(gltf.bytes.data()) + packed.offset;
  char* to = gltf.bytes.data() + start;
  const auto count = static_cast<std::size_t>(packed.count),
             stride = static_cast<std::size_t>(packed.stride),
             length = static_cast<std::size_t>(packed.size);
  const int failed =
      packed.mode == "ATTRIBUTES"  ? meshopt_decodeVertexBuffer(to, count, stride, from, length)
      : packed.mode == "TRIANGLES" ? meshopt_decodeIndexBuffer(to, count, stride, from, length)
                                   : meshopt_decodeIndexSequence(to, count, stride, from, length);
  if (failed != 0)
    throw bad_input(user + " cannot be unpacked: it is damaged, or of a newer codec",
                    "export it without mesh compression");
  apply_filter(packed, to);
  view.offset = static_cast<std::int64_t>(start);
  view.packed.reset();
}

#endif
#ifdef SINEW_DRACO

constexpr std::int64_t max_per_byte = 100;  // points or faces; usual are one or two

Error not_draco(const std::string& user, const std::string& what) {
  return damaged_gltf(user + "'s Draco data " + what);
}

/// The numbers of faces and points that Draco's header declares: before its decoder allocates them.
std::array<std::uint64_t, 2> declared(std::string_view data, const std::string& user) {
  constexpr std::size_t header = 11;
  const auto byte = [&](std::size_t at) {
    if (at >= data.size()) throw not_draco(user, "is cut short");
    return static_cast<unsigned char>(data[at]);
  };
  constexpr unsigned mesh = 1, has_metadata = 0x80, edgebreaker = 1;
  if (!data.starts_with("DRACO") || byte(5) != 2 || byte(6) != 2 || byte(7) != mesh)
    throw not_draco(user, "is no mesh of version 2.2");
  if ((byte(10) & has_metadata) != 0)
    throw bad_input(user + "'s Draco data has metadata", "export it without");
  const bool by_edges = byte(8) == edgebreaker;
  std::size_t at = header + (by_edges ? 1 : 0);
  const auto number = [&] {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < 63; shift += 7) {
      const std::uint64_t part = byte(at++);
      value |= (part & 0x7f) << shift;
      if ((part & 0x80) == 0) break;
    }
    return value;
  };
  const std::uint64_t first = number(), second = number();
  return by_edges ? std::array{second, first} : std::array{first, second};
}

template <class Number>
void put_values(const draco::Mesh& mesh, const draco::PointAttribute& attribute, int parts,
                char* to) {
  std::array<Number, 4> values{};
  const std::size_t size = static_cast<std::size_t>(parts) * sizeof(Number);
  for (draco::PointIndex i(0); i < mesh.num_points(); ++i, to += size) {
    attribute.ConvertValue(attribute.mapped_index(i), static_cast<std::int8_t>(parts),
                           values.data());
    std::memcpy(to, values.data(), size);
  }
}

void put_values(const draco::Mesh& mesh, const draco::PointAttribute& attribute, int parts,
                GltfNumber number, char* to) {
  if (number == GltfNumber::int8) return put_values<std::int8_t>(mesh, attribute, parts, to);
  if (number == GltfNumber::uint8) return put_values<std::uint8_t>(mesh, attribute, parts, to);
  if (number == GltfNumber::int16) return put_values<std::int16_t>(mesh, attribute, parts, to);
  if (number == GltfNumber::uint16) return put_values<std::uint16_t>(mesh, attribute, parts, to);
  if (number == GltfNumber::uint32) return put_values<std::uint32_t>(mesh, attribute, parts, to);
  put_values<float>(mesh, attribute, parts, to);
}

/// Gives an accessor bytes of its own, and returns their start.
char* fresh(CheckedGltf& gltf, GltfAccessor& accessor, std::int64_t size) {
  const std::size_t start = room_for(size, gltf);
  accessor.view = static_cast<int>(gltf.document.views.size());
  accessor.offset = 0;
  gltf.document.views.push_back({0, static_cast<std::int64_t>(start), size, 0});
  return gltf.bytes.data() + start;
}

/// The accessor of that index, without data as yet, with as many elements as Draco has: some
/// exporters count points before Draco joins or splits them.
GltfAccessor& empty_accessor(CheckedGltf& gltf, int index, std::int64_t count,
                             const std::string& user) {
  check_index(index, gltf.document.accessors, user, "accessor");
  GltfAccessor& accessor = gltf.document.accessors[static_cast<std::size_t>(index)];
  accessor.count = count;
  return accessor;
}

std::unique_ptr<draco::Mesh> decoded(std::string_view data, const std::string& user) {
  draco::DecoderBuffer buffer;
  buffer.Init(data.data(), data.size());
  auto mesh = draco::Decoder().DecodeMeshFromBuffer(&buffer);
  if (!mesh.ok()) throw not_draco(user, "is damaged");
  return std::move(mesh).value();
}

void put_mesh(CheckedGltf& gltf, GltfPrimitive& primitive, const draco::Mesh& mesh,
              const std::string& user) {
  for (const auto& [name, id] : primitive.draco_attributes) {
    const auto found = primitive.attributes.find(name);
    const auto* attribute = mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(id));
    if (found == primitive.attributes.end()) continue;
    if (attribute == nullptr) throw not_draco(user, "lacks " + shown(name));
    GltfAccessor& accessor = empty_accessor(gltf, found->second, mesh.num_points(), user);
    const int parts = components_of(accessor.type);
    if (parts > 4) throw not_draco(user, "has matrices");
    put_values(mesh, *attribute, parts, accessor.number,
               fresh(gltf, accessor, accessor.count * parts * size_of(accessor.number)));
  }
  GltfAccessor& corners =
      empty_accessor(gltf, primitive.indices, 3 * std::int64_t{mesh.num_faces()}, user);
  corners.number = GltfNumber::uint32;
  char* to = fresh(gltf, corners, 4 * corners.count);
  for (draco::FaceIndex i(0); i < mesh.num_faces(); ++i)
    for (const draco::PointIndex& corner : mesh.face(i)) {
      const std::uint32_t point = corner.value();
      std::memcpy(to, &point, sizeof point);
      to += sizeof point;
    }
  primitive.mode = GltfMode::triangles;
}

void unpack_primitive(CheckedGltf& gltf, GltfPrimitive& primitive, const std::string& user) {
  const auto position = primitive.attributes.find("POSITION");
  if (position == primitive.attributes.end()) return;
  check_index(position->second, gltf.document.accessors, user, "accessor");
  const auto& points = gltf.document.accessors[static_cast<std::size_t>(position->second)];
  if (points.view >= 0) return;  // not compressed as well
  check_index(primitive.draco, gltf.document.views, user, "bufferView");
  check_index(primitive.indices, gltf.document.accessors, user, "accessor");
  const GltfView& view = gltf.document.views[static_cast<std::size_t>(primitive.draco)];
  const std::string_view data(gltf.bytes.data() + view.offset, static_cast<std::size_t>(view.size));
  const auto [faces, vertices] = declared(data, user);
  const std::int64_t count =
      gltf.document.accessors[static_cast<std::size_t>(primitive.indices)].count;
  if (3 * faces != static_cast<std::uint64_t>(count))
    throw not_draco(
        user, "has " + std::to_string(faces) + " faces, its accessor " + std::to_string(count / 3));
  if (count / 3 > max_per_byte * view.size ||
      vertices > static_cast<std::uint64_t>(max_per_byte * view.size))
    throw not_draco(user, "is too short for so much");
  put_mesh(gltf, primitive, *decoded(data, user), user);
}

#endif

}  // namespace

void unpack_gltf([[maybe_unused]] CheckedGltf& gltf) {
#ifdef SINEW_MESHOPT
  for (std::size_t i = 0; i < gltf.document.views.size(); ++i)
    if (gltf.document.views[i].packed) unpack_view(gltf, i);
#endif
#ifdef SINEW_DRACO
  for (std::size_t i = 0; i < gltf.document.meshes.size(); ++i)
    for (GltfPrimitive& primitive : gltf.document.meshes[i].primitives)
      if (primitive.draco >= 0) unpack_primitive(gltf, primitive, nth("meshes", i));
#endif
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/checks.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include <sinew/core/file.h>
#include <sinew/core/text.h>
#include <sinew/io/gltf/converted.h>
#include <sinew/io/gltf/detail/accessors.h>
#include <sinew/io/gltf/detail/compression.h>
#include <sinew/io/gltf/detail/container.h>

namespace sinew {
namespace {

/// Extensions that are read, or about appearance, light and avatars, which do not change shapes.
bool leaves_shapes(std::string_view extension) {
  if (std::ranges::count(gltf_codecs, extension) > 0) return true;
  constexpr std::array<std::string_view, 14> harmless = {"KHR_materials_",
                                                         "KHR_texture_",
                                                         "EXT_texture_",
                                                         "MSFT_texture_",
                                                         "KHR_lights_",
                                                         "EXT_lights_",
                                                         "KHR_xmp",
                                                         "KHR_animation_pointer",
                                                         "KHR_node_",
                                                         "EXT_mesh_features",
                                                         "EXT_structural_metadata",
                                                         "FB_ngon_encoding",
                                                         "VRM",
                                                         "KHR_mesh_quantization"};
  return std::any_of(harmless.begin(), harmless.end(),
                     [&](std::string_view start) { return extension.starts_with(start); });
}

std::string cure_for(std::string_view extension) {
  const auto names = [&](const char* part) { return extension.find(part) != extension.npos; };
  if (extension == "EXT_meshopt_compression")
    return "export without mesh compression, or build sinew with libmeshoptimizer-dev";
  if (names("draco")) return "export without mesh compression, or build sinew with libdraco-dev";
  if (names("meshopt")) return "export without mesh compression";
  if (names("instancing")) return "export without instancing";
  return "export without it";
}

/// glTF 2 without required extensions that change shapes and are not read.
void check_version(const GltfDocument& document) {
  const auto is_2 = [](std::string_view version) { return version.starts_with("2."); };
  if (!is_2(document.version) || document.min_version > "2.0")
    throw bad_input("it is of glTF version " +
                        shown(is_2(document.version) ? document.min_version : document.version),
                    "export it as glTF 2.0");
  for (const std::string& extension : document.extensions_required)
    if (!leaves_shapes(extension))
      throw bad_input("it needs the extension " + shown(extension), cure_for(extension));
}

/// Every view lies in its buffer; then the buffers are joined: views count from the start. Of
/// packed views this holds for what they are packed in.
void join_buffers(GltfDocument& document) {
  const bool unpacks = std::ranges::count(gltf_codecs, "EXT_meshopt_compression") > 0;
  std::vector<std::int64_t> starts = {0};
  for (const GltfBuffer& buffer : document.buffers) starts.push_back(starts.back() + buffer.size);
  for (std::size_t i = 0; i < document.views.size(); ++i) {
    GltfView& view = document.views[i];
    if (!unpacks) view.packed.reset();
    int& index = view.packed ? view.packed->buffer : view.buffer;
    std::int64_t& offset = view.packed ? view.packed->offset : view.offset;
    const std::int64_t size = view.packed ? view.packed->size : view.size;
    check_index(index, document.buffers, nth("bufferViews", i), "buffer");
    const auto buffer = static_cast<std::size_t>(index);
    if (offset + size > document.buffers[buffer].size)
      throw damaged_gltf(nth("bufferViews", i) + " ends at byte " + std::to_string(offset + size) +
                         " of a buffer of " + std::to_string(document.buffers[buffer].size));
    offset += starts[buffer];
    index = 0;
  }
  document.buffers.clear();
}

/// Whether indices may be of that number type.
bool counts(GltfNumber number) {
  return number == GltfNumber::uint8 || number == GltfNumber::uint16 ||
         number == GltfNumber::uint32;
}

/// Checks that `count` elements of `size` bytes from `offset` lie in the view.
void check_extent(const GltfDocument& document, const std::string& user, int view_index,
                  std::int64_t offset, std::int64_t count, std::int64_t size) {
  check_index(view_index, document.views, user, "bufferView");
  const GltfView& view = document.views[static_cast<std::size_t>(view_index)];
  const std::int64_t step = view.stride > 0 ? view.stride : size;
  if (step < size)
    throw damaged_gltf(user + " has elements of " + std::to_string(size) + " bytes every " +
                       std::to_string(step));
  const std::int64_t end = offset + (count - 1) * step + size;  // below 2^31 + 2^31 252 + 64
  if (end > view.size)
    throw damaged_gltf(user + " ends at byte " + std::to_string(end) + " of a bufferView of " +
                       std::to_string(view.size));
}

/// Bytes.
std::int64_t element_size(const GltfAccessor& accessor) {
  return std::int64_t{size_of(accessor.number)} * components_of(accessor.type);
}

/// `bytes`: of all buffers; elements that are zero for want of a view take none.
void check_accessor(const GltfDocument& document, std::size_t index, std::int64_t bytes) {
  const GltfAccessor& accessor = document.accessors[index];
  const std::string user = nth("accessors", index);
  const std::int64_t size = element_size(accessor);
  if (accessor.view >= 0)
    check_extent(document, user, accessor.view, accessor.offset, accessor.count, size);
  if (!accessor.sparse) return;
  if (accessor.view < 0 && accessor.count * components_of(accessor.type) > bytes)
    throw damaged_gltf(user + " has " + std::to_string(accessor.count) +
                       " elements, more than its file has");
  const GltfSparse& sparse = *accessor.sparse;
  if (sparse.count > accessor.count || !counts(sparse.index_number))
    throw damaged_gltf(user + ".sparse does not fit it");
  check_extent(document, user + ".sparse.indices", sparse.index_view, sparse.index_offset,
               sparse.count, size_of(sparse.index_number));
  check_extent(document, user + ".sparse.values", sparse.value_view, sparse.value_offset,
               sparse.count, size);
}

/// Checks the indices of a sparse accessor, which must have been checked.
void check_sparse(const CheckedGltf& gltf, std::size_t index) {
  const GltfAccessor& accessor = gltf.document.accessors[index];
  const GltfSparse& sparse = *accessor.sparse;
  const GltfElements places(gltf, sparse.index_view, sparse.index_offset, sparse.index_number);
  for (std::int64_t i = 0; i < sparse.count; ++i)
    if (const std::int64_t at = places.index(i); at >= accessor.count)
      throw damaged_gltf(nth("accessors", index) + ".sparse names element " + std::to_string(at) +
                         " of " + std::to_string(accessor.count));
}

void check_accessors(const CheckedGltf& gltf) {
  const auto& accessors = gltf.document.accessors;
  for (std::size_t i = 0; i < accessors.size(); ++i)
    check_accessor(gltf.document, i, static_cast<std::int64_t>(gltf.bytes.size()));
  for (std::size_t i = 0; i < accessors.size(); ++i)
    if (accessors[i].sparse) check_sparse(gltf, i);
}

/// Whole numbers of up to 16 bits are those of KHR_mesh_quantization.
void check_positions(const GltfAccessor& accessor, const std::string& user) {
  if (accessor.type != "VEC3" || accessor.number == GltfNumber::uint32)
    throw bad_input(user + " are " + accessor.type + " of component type " +
                        std::to_string(static_cast<int>(accessor.number)) +
                        ", not VEC3 of 5126 or 5120 to 5123",
                    "export positions as floats");
}

/// Targets without data are zero.
void check_target(const GltfDocument& document, int target, std::int64_t points,
                  const std::string& user) {
  check_index(target, document.accessors, user, "accessor");
  const GltfAccessor& accessor = document.accessors[static_cast<std::size_t>(target)];
  check_positions(accessor, user);
  if (accessor.count != points)
    throw damaged_gltf(user + " have " + std::to_string(accessor.count) + " of " +
                       std::to_string(points) + " points");
}

void check_corners(const GltfAccessor& accessor, const std::string& user) {
  if (accessor.type != "SCALAR" || !counts(accessor.number) || accessor.normalized)
    throw damaged_gltf(user + " are not plain unsigned numbers");
  if (accessor.sparse) throw bad_input(user + " are sparse", "export without sparse accessors");
}

/// Refuses those of surfaces that this build does not unpack.
const GltfAccessor& data_of(const GltfDocument& document, int index, const std::string& user) {
  const GltfAccessor& accessor = accessor_of(document, index, user);
  if (accessor.view >= 0 || accessor.sparse) return accessor;
  throw bad_input(user + " have no data", "export without mesh compression");
}

void check_count(GltfMode mode, std::int64_t corners, const std::string& user) {
  if (corners < 3 || (mode == GltfMode::triangles && corners % 3 != 0))
    throw damaged_gltf(user + " has " + std::to_string(corners) +
                       " corners, which make no triangles");
}

void check_surface(const GltfDocument& document, const GltfPrimitive& primitive,
                   const std::string& user) {
  const std::string positions = user + "'s positions", indices = user + "'s indices";
  const GltfAccessor* corners = &data_of(document, primitive.positions(), positions);
  check_positions(*corners, positions);
  for (const int target : primitive.targets)
    if (target >= 0) check_target(document, target, corners->count, user + "'s morph targets");
  if (primitive.indices >= 0) {
    corners = &data_of(document, primitive.indices, indices);
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

void check_node(const GltfDocument& document, std::size_t index) {
  const GltfNode& node = document.nodes[index];
  const std::string user = nth("nodes", index);
  if (node.mesh >= 0) check_index(node.mesh, document.meshes, user, "mesh");
  if (node.skin >= 0) check_index(node.skin, document.skins, user, "skin");
  const auto& m = node.matrix;  // column-major: these are the last row
  if (!m.empty() && (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1))
    throw damaged_gltf(user + "'s matrix does not end in the row 0 0 0 1");
}

/// The topmost nodes of the default scene: of the first one where none is named, all nodes without
/// parent where there are no scenes.
std::vector<int> roots_of_scene(const GltfDocument& document, const GltfTree& tree) {
  if (document.scene >= 0) check_index(document.scene, document.scenes, "scene", "scene");
  if (!document.scenes.empty())
    return document.scenes[static_cast<std::size_t>(std::max(document.scene, 0))];
  std::vector<int> roots;
  for (std::size_t i = 0; i < tree.parents.size(); ++i)
    if (tree.parents[i] < 0) roots.push_back(static_cast<int>(i));
  return roots;
}

/// All nodes of the scene, each once, parents first. Some exporters list nodes beside those that
/// they are children of.
std::vector<int> shown_nodes(const GltfDocument& document, const GltfTree& tree) {
  std::vector<bool> within(document.nodes.size());  // the list, or below one of it
  const std::vector<int> listed = roots_of_scene(document, tree);
  for (const int root : listed) {
    check_index(root, document.nodes, "its scene", "node");
    within[static_cast<std::size_t>(root)] = true;
  }
  std::vector<bool> taken(document.nodes.size());
  for (const int node : tree.order) {
    const auto at = static_cast<std::size_t>(node);
    taken[at] = tree.parents[at] >= 0 && within[static_cast<std::size_t>(tree.parents[at])];
    within[at] = within[at] || taken[at];
  }
  std::vector<int> shown;
  for (const int root : listed) {
    if (!taken[static_cast<std::size_t>(root)]) shown.push_back(root);
    taken[static_cast<std::size_t>(root)] = true;
  }
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const auto& children = document.nodes[static_cast<std::size_t>(shown[i])].children;
    shown.insert(shown.end(), children.begin(), children.end());
  }
  return shown;
}

CheckedGltf checked(const GltfContainer& container, const std::filesystem::path& folder) {
  CheckedGltf gltf{gltf_document(container.json), {}, {}, {}};
  GltfDocument& document = gltf.document;
  check_version(document);
  gltf.bytes = gltf_bytes(document.buffers, container.binary, folder);
  join_buffers(document);
  unpack_gltf(gltf);
  check_accessors(gltf);
  for_each_primitive(document, [&](const GltfPrimitive& primitive, const std::string& user) {
    check_primitive(document, primitive, user);
  });
  for (std::size_t i = 0; i < document.nodes.size(); ++i) check_node(document, i);
  gltf.tree = gltf_tree(document);
  gltf.shown = shown_nodes(document, gltf.tree);
  check_gltf_skins(document);
  check_gltf_animations(document);
  return gltf;
}

}  // namespace

const GltfAccessor& accessor_of(const GltfDocument& document, int index, const std::string& user) {
  check_index(index, document.accessors, user, "accessor");
  const GltfAccessor& accessor = document.accessors[static_cast<std::size_t>(index)];
  constexpr std::int64_t max_zeros = 1'000'000;
  if (accessor.view < 0 && !accessor.sparse && accessor.count > max_zeros)
    throw damaged_gltf(user + " are " + std::to_string(accessor.count) + " zeros");
  return accessor;
}

CheckedGltf checked_gltf(const std::filesystem::path& path) {
  const std::filesystem::path source = gltf_of(path);
  std::string file = read_gltf_file(source);  // its errors name the path
  try {
    return checked(gltf_container(std::move(file), source.extension()), source.parent_path());
  } catch (const Error& error) {
    throw error.with_context({path.string()});
  }
}

}  // namespace sinew

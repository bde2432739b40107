// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/guard.h>

#include <utility>

#include <sinew/core/error.h>
#include <sinew/core/file.h>
#include <sinew/io/gltf/buffers.h>
#include <sinew/io/gltf/checks.h>
#include <sinew/io/gltf/container.h>
#include <sinew/io/gltf/json.h>

namespace sinew {
namespace {

/// The nodes of the scene, parents first.
std::vector<int> shown_nodes(const GltfDocument& document) {
  std::vector<int> shown = document.scenes.front();
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const auto& children = document.nodes[static_cast<std::size_t>(shown[i])].children;
    shown.insert(shown.end(), children.begin(), children.end());
  }
  return shown;
}

/// Empties meshes that no node shows, and leaves nothing but surfaces in the others.
void drop_unseen(GuardedGltf& gltf) {
  std::vector<bool> seen(gltf.document.meshes.size());
  for (const int node : gltf.shown)
    if (const int mesh = gltf.document.nodes[static_cast<std::size_t>(node)].mesh; mesh >= 0)
      seen[static_cast<std::size_t>(mesh)] = true;
  for (std::size_t i = 0; i < seen.size(); ++i)
    std::erase_if(gltf.document.meshes[i].primitives, [&](const GltfPrimitive& primitive) {
      return !seen[i] || !primitive.is_surface();
    });
}

GuardedGltf guarded(const GltfContainer& container, const std::filesystem::path& folder) {
  GuardedGltf gltf{gltf_document(container.json), {}, {}};
  check_gltf_version(gltf.document);
  gltf.bytes = gltf_bytes(gltf.document.buffers, container.binary, folder);
  join_gltf_buffers(gltf.document);
  check_gltf_accessors(gltf.document);
  check_gltf_sparse(gltf);
  check_gltf_meshes(gltf.document);
  check_gltf_nodes(gltf.document);
  check_gltf_skins(gltf.document);
  check_gltf_animations(gltf.document);
  gltf.shown = shown_nodes(gltf.document);
  drop_unseen(gltf);
  return gltf;
}

}  // namespace

GuardedGltf guarded_gltf(const std::filesystem::path& path) {
  std::string file = read_file(path, most_gltf_bytes);  // its errors name the path themselves
  try {
    return guarded(gltf_container(std::move(file), path.extension()), path.parent_path());
  } catch (const Error& error) {
    throw error.with_context({path.string()});
  }
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/read_gltf.h>

#include <new>

#include <sinew/core/error.h>
#include <sinew/io/gltf/bind_pose.h>
#include <sinew/io/gltf/guard.h>
#include <sinew/io/gltf/shapes.h>

namespace sinew {
namespace {

bool is_skinned(const GuardedGltf& gltf) {
  for (const int index : gltf.shown) {
    const GltfNode& node = gltf.document.nodes[static_cast<std::size_t>(index)];
    if (node.mesh >= 0 && node.skin >= 0) return true;
  }
  return false;
}

/// A skin's bind pose puts its meshes, their nodes do not.
std::vector<GltfShape> shapes_of(const GuardedGltf& gltf) {
  const GltfTree tree = gltf_tree(gltf.document);
  std::vector<Affine> local;
  for (const GltfNode& node : gltf.document.nodes) local.push_back(place_of(node).affine());
  const std::vector<Affine> global = global_places(tree, local);
  const GltfBindPose bind = is_skinned(gltf) ? gltf_bind_pose(gltf, tree) : GltfBindPose();
  std::vector<GltfShape> shapes;
  for (const int index : gltf.shown) {
    const GltfNode& node = gltf.document.nodes[static_cast<std::size_t>(index)];
    if (node.mesh >= 0)
      shapes.push_back({index, node.skin < 0 ? global[static_cast<std::size_t>(index)]
                                             : bind.meshes[static_cast<std::size_t>(node.skin)]});
  }
  return shapes;
}

PolygonSoup soup_of(const GuardedGltf& gltf) {
  const PolygonSoup soup = gltf_triangles(gltf, shapes_of(gltf)).soup;
  if (soup.polygons.empty())
    throw bad_input("its scene shows no triangles", "export it with a mesh");
  return soup;
}

}  // namespace

PolygonSoup read_gltf(const std::filesystem::path& path) {
  try {
    const GuardedGltf gltf = guarded_gltf(path);
    try {
      return soup_of(gltf);
    } catch (const Error& error) {
      throw error.with_context({path.string()});
    }
  } catch (const std::bad_alloc&) {
    throw bad_input({path.string()}, "it takes more memory than there is",
                    "reduce its number of triangles");
  }
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <utility>

#include <sinew/io/gltf/checks.h>

namespace sinew {
namespace {

constexpr int deepest = 1000;  // VTK visits nodes by recursion; the longest ropes have 200

/// Each node's parent, -1 for none.
std::vector<int> parents_of(const GltfDocument& document) {
  std::vector<int> parents(document.nodes.size(), -1);
  for (std::size_t i = 0; i < document.nodes.size(); ++i)
    for (const int child : document.nodes[i].children) {
      check_index(child, document.nodes, nth("nodes", i), "child");
      int& parent = parents[static_cast<std::size_t>(child)];
      if (parent >= 0) throw damaged_gltf("node " + std::to_string(child) + " has two parents");
      parent = static_cast<int>(i);
    }
  return parents;
}

/// Level by level from the nodes without parents: what is never met goes in circles.
void check_trees(const GltfDocument& document, const std::vector<int>& parents) {
  std::vector<int> level;
  for (std::size_t i = 0; i < parents.size(); ++i)
    if (parents[i] < 0) level.push_back(static_cast<int>(i));
  std::size_t met = 0;
  for (int depth = 0; !level.empty(); ++depth) {
    if (depth > deepest) throw damaged_gltf("its nodes are nested more than 1000 deep");
    met += level.size();
    std::vector<int> next;
    for (const int node : level) {
      const auto& children = document.nodes[static_cast<std::size_t>(node)].children;
      next.insert(next.end(), children.begin(), children.end());
    }
    level = std::move(next);
  }
  if (met < parents.size()) throw damaged_gltf("some of its nodes are children of themselves");
}

void check_node(const GltfDocument& document, std::size_t index) {
  const GltfNode& node = document.nodes[index];
  const std::string user = nth("nodes", index);
  if (node.mesh >= 0) check_index(node.mesh, document.meshes, user, "mesh");
  if (node.skin >= 0) check_index(node.skin, document.skins, user, "skin");
  const auto& m = node.matrix;  // column by column: these are the last row
  if (!m.empty() && (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1))
    throw damaged_gltf(user + "'s matrix does not end in the row 0 0 0 1");
}

/// Leaves one scene, the default one, whose nodes are roots, each once.
void choose_scene(GltfDocument& document, const std::vector<int>& parents) {
  std::vector<int> roots;
  if (document.scene >= 0) check_index(document.scene, document.scenes, "scene", "scene");
  if (document.scenes.empty()) {
    for (std::size_t i = 0; i < parents.size(); ++i)
      if (parents[i] < 0) roots.push_back(static_cast<int>(i));
  } else {
    roots = document.scenes[static_cast<std::size_t>(std::max(document.scene, 0))];
  }
  std::vector<bool> listed(parents.size());
  for (const int root : roots) {
    check_index(root, document.nodes, "its scene", "node");
    const auto at = static_cast<std::size_t>(root);
    if (parents[at] >= 0 || listed[at])
      throw damaged_gltf("its scene holds node " + std::to_string(root) + " twice");
    listed[at] = true;
  }
  document.scenes = {std::move(roots)};
  document.scene = 0;
}

}  // namespace

void check_gltf_nodes(GltfDocument& document) {
  for (std::size_t i = 0; i < document.nodes.size(); ++i) check_node(document, i);
  const std::vector<int> parents = parents_of(document);
  check_trees(document, parents);
  choose_scene(document, parents);
}

}  // namespace sinew

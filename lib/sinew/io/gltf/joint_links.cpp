// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/joint_links.h>

#include <cmath>

namespace sinew {
namespace {

constexpr double uneven = 1e-4;  // of a node's scale; more is not rounding

std::size_t at(int index) { return static_cast<std::size_t>(index); }

std::vector<Affine> still_places(const GltfNodeMotion& nodes) {
  std::vector<Affine> places;
  for (const GltfPlace& place : nodes.places) places.push_back(place.affine());
  return places;
}

/// For each node, whether all nodes down to it keep an even size.
std::vector<bool> even_nodes(const GltfTree& tree, const GltfNodeMotion& nodes) {
  std::vector<bool> even(tree.parents.size());
  for (const int node : tree.order) {
    const int above = tree.parents[at(node)];
    even[at(node)] = (above < 0 || even[at(above)]) && nodes.curves[at(node)].scale.empty() &&
                     even_scale(nodes.places[at(node)].affine().linear(), uneven) > 0;
  }
  return even;
}

/// For each node, what the nodes between it and the nearest joint above do.
std::vector<GltfLink> links_of_nodes(const GltfBindPose& bind, const GltfTree& tree,
                                     const GltfNodeMotion& nodes,
                                     const std::vector<Affine>& local) {
  std::vector<bool> is_joint(local.size());
  for (const GltfJoint& joint : bind.joints) is_joint[at(joint.node)] = true;
  std::vector<GltfLink> links(local.size());
  for (const int node : tree.order) {
    const int above = tree.parents[at(node)];
    if (above < 0 || is_joint[at(above)]) continue;
    links[at(node)].between = links[at(above)].between * local[at(above)];
    links[at(node)].exact = links[at(above)].exact && nodes.curves[at(above)].empty();
  }
  return links;
}

bool mirrors(const GltfBindPose& bind, int joint) {
  return joint >= 0 && bind.joints[at(joint)].bind.linear().determinant() < 0;
}

}  // namespace

std::vector<GltfLink> joint_links(const GltfBindPose& bind, const GltfTree& tree,
                                  const GltfNodeMotion& nodes) {
  const std::vector<bool> even = even_nodes(tree, nodes);
  const std::vector<Affine> local = still_places(nodes), global = global_places(tree, local);
  const std::vector<GltfLink> of_nodes = links_of_nodes(bind, tree, nodes, local);
  std::vector<GltfLink> links;
  for (std::size_t i = 0; i < bind.joints.size(); ++i) {
    const GltfJoint& joint = bind.joints[i];
    GltfLink link = of_nodes[at(joint.node)];
    link.exact = link.exact && even[at(joint.node)] && !mirrors(bind, static_cast<int>(i)) &&
                 !mirrors(bind, joint.parent);
    if (joint.parent >= 0) {
      const int above = bind.joints[at(joint.parent)].node;
      link.scale = std::cbrt(global[at(above)].linear().determinant());
    }
    links.push_back(link);
  }
  return links;
}

Vec3 bound_head(const GltfBindPose& bind, int joint) {
  return joint < 0 ? Vec3::Zero() : Vec3(bind.joints[at(joint)].bind.translation());
}

Mat3 bound_turn(const GltfBindPose& bind, int joint) {
  return joint < 0 ? Mat3::Identity() : nearest_rotation(bind.joints[at(joint)].bind.linear());
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// What lies between the joints of a glTF file, and whether keys can pass it unchanged.
#pragma once

#include <cstddef>
#include <vector>

#include <sinew/io/gltf/bind_pose.h>
#include <sinew/io/gltf/node_motion.h>

namespace sinew {

/// From a joint's parent joint (from the scene for a topmost one) to the joint.
struct GltfLink {
  Affine between = Affine::Identity();  ///< what static nodes between the two do
  double scale = 1;                     ///< by which all from the parent joint up scales lengths
  bool exact = true;  ///< nothing between the two moves; sizes stay, are even and do not mirror
};

/// One for each joint.
std::vector<GltfLink> joint_links(const GltfBindPose& bind, const GltfTree& tree,
                                  const GltfNodeMotion& nodes);

/// Where a joint's head was bound, and how it was turned there; no joint (-1) is the scene.
Vec3 bound_head(const GltfBindPose& bind, int joint);
Mat3 bound_turn(const GltfBindPose& bind, int joint);

}  // namespace sinew

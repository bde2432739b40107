// SPDX-License-Identifier: GPL-3.0-or-later
// Converts the motion of a glTF file's nodes, which move in their parents' frames, to that of bones
// (<sinew/rig/motion.h>), whose axes at rest are the scene's.
//
//     const Motion motion = joint_motion(bind, gltf.tree, gltf_node_motion(gltf, 0), 60);
//
// With B_j the bind of joint j (node_tree.h), p its parent joint, C the transform of static nodes
// between the two, q and t the rotation and translation of its node, and rot() the rotation in a
// matrix:
//   rotation    = rot(B_p) rot(C) q rot(B_j)^-1
//   translation = s rot(B_p) (C t) - (head_j - head_p),   s: the scale of all above the joint
// Both are affine in q and t, so that every key becomes a key and the interpolation is unchanged:
// step, slerp, and glTF's cubic splines.
//
// This fails where a node between two joints moves, or where a node above a joint or the joint
// itself changes its scale, is scaled unevenly or mirrored. Such a joint is sampled: G B^-1 (G its
// node's transform in the scene) places its head, and the nearest rotation turns it; bones are
// rigid and ignore the scale itself. Interpolation between samples is linear; steps become steep
// ramps.
#pragma once

#include <sinew/io/gltf/detail/node_motion.h>
#include <sinew/rig/motion.h>

namespace sinew {

/// Bone i is joint i. Bones that stay as bound, to 1e-6 rad and 1e-6 of the skeleton's size, have
/// no track; those fixed in another pose have tracks of one key. Sampled joints get samples at all
/// keys and `rate` times a second. Throws bad input (without the path) where that takes more than
/// 2e7 node transforms, and for transforms that are not finite.
Motion joint_motion(const GltfBindPose& bind, const GltfTree& tree, const GltfNodeMotion& nodes,
                    double rate);

}  // namespace sinew

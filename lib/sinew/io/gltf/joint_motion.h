// SPDX-License-Identifier: GPL-3.0-or-later
// From the nodes of a glTF file, which move in their parents' frames, to the bones of motion.h,
// which move in directions that at rest are the scene's.
//
// With B_j the bind of joint j (node_tree.h), p its parent joint, C what static nodes between the
// two do, q and t the rotation and translation of its node, and rot() the rotation in a matrix:
//   rotation    = rot(B_p) rot(C) q rot(B_j)^-1
//   translation = s rot(B_p) (C t) - (head_j - head_p),   s: the scale of all above the joint
// Both are affine in q and t, so that every key becomes a key and the ways between stay what they
// are: step, slerp, and glTF's cubic splines.
//
// Not so where a node between two joints moves, or where a node above a joint or the joint itself
// changes its size, is scaled unevenly or mirrored. Such a joint is sampled: G B^-1 (G its node's
// place in the scene) puts its head, and the rotation nearest to it turns it; bones are rigid and
// leave the scale itself away. Samples are linear between; steps become steep ways.
#pragma once

#include <sinew/io/gltf/node_motion.h>
#include <sinew/rig/motion.h>

namespace sinew {

/// Bone i is joint i. Bones that stay as bound, to 1e-6 rad and 1e-6 of the skeleton's size, have
/// no track; those that stay otherwise have tracks of one key. Sampled joints get samples at all
/// keys and `rate` times a second. Throws bad input (without the path) where that takes more than
/// 2e7 places of nodes, and for places that are not finite.
Motion joint_motion(const GltfBindPose& bind, const GltfTree& tree, const GltfNodeMotion& nodes,
                    double rate);

}  // namespace sinew

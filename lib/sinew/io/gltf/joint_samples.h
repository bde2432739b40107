// SPDX-License-Identifier: GPL-3.0-or-later
// Tracks of the joints of a glTF file whose keys cannot be taken as they are: by sampling.
#pragma once

#include <vector>

#include <sinew/io/gltf/joint_links.h>
#include <sinew/rig/motion.h>

namespace sinew {

/// Puts samples at all keys and `rate` times a second, linear between, into the tracks of joints
/// whose links are not exact: G B^-1 (G where the joint's node is, B where it was bound) puts the
/// head, and the rotation nearest to it turns the bone. Throws bad input (without the path) where
/// that takes more than 2e7 places of nodes.
void put_samples(const GltfBindPose& bind, const GltfTree& tree, const GltfNodeMotion& nodes,
                 const std::vector<GltfLink>& links, double rate, std::vector<Track>& tracks);

}  // namespace sinew

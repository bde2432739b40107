// SPDX-License-Identifier: GPL-3.0-or-later
// How much each bone moves each vertex, as the file says.
#pragma once

#include <vector>

#include <sinew/io/gltf/bind_pose.h>
#include <sinew/io/gltf/shapes.h>
#include <sinew/rig/skinning.h>

namespace sinew {

using SkinWeights = BoneWeights;  ///< of vertices

/// The weights of vertices of skinned meshes, up to eight sets of four (JOINTS_0 to JOINTS_7);
/// bones count as `bind.joints`. A vertex whose weights are all zero has none. Throws bad input
/// (without the path) for a mesh without weights, joints that the skin does not have, and weights
/// that are negative or not finite.
SkinWeights gltf_skin_weights(const GuardedGltf& gltf, const GltfBindPose& bind,
                              const std::vector<GltfVertex>& vertices);

}  // namespace sinew

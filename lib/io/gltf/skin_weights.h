// SPDX-License-Identifier: GPL-3.0-or-later
// How much each bone moves each vertex, as the file says.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "io/gltf/bind_pose.h"
#include "io/gltf/shapes.h"

namespace sinew {

struct BoneWeight {
  int bone = -1;
  double weight = 0;  ///< > 0
};

/// Of n vertices.
struct SkinWeights {
  std::vector<std::uint32_t> first;  ///< n + 1 long; vertex i has [first[i], first[i + 1])
  std::vector<BoneWeight> weights;   ///< of each vertex the heaviest first, each bone once, sum 1

  std::span<const BoneWeight> of(std::size_t i) const {
    return {weights.data() + first[i], first[i + 1] - first[i]};
  }
};

/// The weights of vertices of skinned meshes, up to eight sets of four (JOINTS_0 to JOINTS_7);
/// bones count as `bind.joints`. A vertex whose weights are all zero has none. Throws bad input
/// (without the path) for a mesh without weights, joints that the skin does not have, and weights
/// that are negative or not finite.
SkinWeights gltf_skin_weights(const GuardedGltf& gltf, const GltfBindPose& bind,
                              const std::vector<GltfVertex>& vertices);

}  // namespace sinew

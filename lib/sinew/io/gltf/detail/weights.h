// SPDX-License-Identifier: GPL-3.0-or-later
// The joints that vertices of a skinned mesh follow, and their weights.
//
//     const std::vector<BoneWeight> weights = GltfWeights(gltf, mesh, 0, joints).of(vertex, bones);
#pragma once

#include <cstddef>
#include <vector>

#include <sinew/io/gltf/checks.h>
#include <sinew/rig/skinning.h>

namespace sinew {

/// Up to eight sets of four joints for each vertex, JOINTS_0 to JOINTS_7.
class GltfWeights {
 public:
  /// Reads a surface of a mesh that a skin of so many joints moves. Throws bad input (without the
  /// path) for joints that do not exist, negative weights, and none at all.
  GltfWeights(const CheckedGltf& gltf, std::size_t mesh, std::size_t primitive, std::size_t joints);

  /// Weights of a vertex, their sum 1, each bone once, the heaviest first; `bones` are those of the
  /// skin's joints. None where all weights are zero.
  std::vector<BoneWeight> of(std::size_t vertex, const std::vector<int>& bones) const;

 private:
  struct Set {
    std::vector<double> joints, weights;  // four of each for a vertex
  };
  std::vector<Set> sets_;
};

}  // namespace sinew

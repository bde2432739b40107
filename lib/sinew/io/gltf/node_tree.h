// SPDX-License-Identifier: GPL-3.0-or-later
// How the nodes of a glTF file hang together, and where they stand.
#pragma once

#include <vector>

#include <sinew/core/vector.h>
#include <sinew/io/gltf/document.h>

namespace sinew {

using Affine = Eigen::Affine3d;

struct GltfTree {
  std::vector<int> parents;  ///< of each node, -1 for none
  std::vector<int> order;    ///< all nodes, depth first: parents before their children
};

/// Of a document that passed the guard.
GltfTree gltf_tree(const GltfDocument& document);

/// A node's place within its parent: x -> translation + rotation (scale x).
struct GltfPlace {
  Vec3 translation = Vec3::Zero();  ///< m where nothing above scales
  Mat3 linear = Mat3::Identity();   ///< rotation and scale; what else a matrix holds
  Quat rotation = Quat::Identity();
  Vec3 scale = Vec3::Ones();
  bool whole = false;  ///< given as a matrix: `linear` holds, not rotation and scale

  Affine affine() const;
};

/// As the file has it.
GltfPlace place_of(const GltfNode& node);

/// Of every node, from what each has within its parent. Some may not be finite.
std::vector<Affine> global_places(const GltfTree& tree, const std::vector<Affine>& local);

/// The factor by which a matrix scales all lengths; 0 where they differ by more than `tolerance`
/// of the largest, or the matrix mirrors, or is not finite.
double even_scale(const Mat3& matrix, double tolerance);

/// The rotation nearest to a matrix (polar decomposition); for a mirroring one, to its opposite's.
Mat3 nearest_rotation(const Mat3& matrix);

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// The hierarchy and transforms of a glTF file's nodes, and the bind pose of its skins: the
// transforms of their joints and meshes at rest.
//
//     const GltfBindPose bind = gltf_bind_pose(checked_gltf("fox.glb"));
//
// A skin's inverse bind matrices I_j map its mesh's space to that of each joint j, so that in mesh
// space joint j was bound at I_j^-1. A file does not say how mesh space maps to the scene; here it
// is M = G I of the skin's topmost joint, with G the joint's transform in the scene by the nodes:
// the body is bound at its topmost joint, at the scene's scale whatever units the mesh is in. The
// transform of a joint at bind is M I_j^-1. Skins that share joints are one skeleton, placed by the
// first of them.
#pragma once

#include <string>
#include <vector>

#include <sinew/core/vector.h>
#include <sinew/io/gltf/document.h>

namespace sinew {

struct CheckedGltf;

using Affine = Eigen::Affine3d;

struct GltfTree {
  std::vector<int> parents;  ///< parents of each node, -1 for none
  std::vector<int> order;    ///< all nodes, depth first: parents before their children
};

/// Throws bad input (without the path) unless the nodes form trees of moderate depth.
GltfTree gltf_tree(const GltfDocument& document);

/// A node's transform relative to its parent: x -> translation + rotation (scale x).
struct GltfPlace {
  Vec3 translation = Vec3::Zero();  ///< m where nothing above scales
  Mat3 linear = Mat3::Identity();   ///< rotation and scale, or the linear part of a matrix
  Quat rotation = Quat::Identity();
  Vec3 scale = Vec3::Ones();
  bool whole = false;  ///< given as a matrix: `linear` holds, not rotation and scale

  Affine affine() const;
};

/// Returns the place as given in the file.
GltfPlace place_of(const GltfNode& node);

/// Transforms of all nodes in the scene, from those relative to their parents. May not be finite.
std::vector<Affine> global_places(const GltfTree& tree, const std::vector<Affine>& local);

/// The factor by which a matrix scales all lengths; 0 where they differ by more than `tolerance`
/// of the largest, or the matrix mirrors, or is not finite.
double even_scale(const Mat3& matrix, double tolerance);

/// The rotation nearest to a matrix (polar decomposition); for a mirroring one, to its opposite's.
Mat3 nearest_rotation(const Mat3& matrix);

struct GltfJoint {
  int node = -1;
  int parent = -1;                   ///< the nearest joint above, an earlier one; -1 for none
  Affine bind = Affine::Identity();  ///< in the scene; scales evenly, to 1 %
};

struct GltfBindPose {
  std::vector<GltfJoint> joints;  ///< joints of all skins in use, each once, depth first
  std::vector<Affine> meshes;     ///< transform M of each skin's meshes
  /// Indices of each skin's joints in `joints`; none for a skin that is not in use.
  std::vector<std::vector<int>> places;
};

/// The skins that move a mesh of the scene; all where none does. Throws bad input (without the
/// path) for a bind matrix that is not finite, cannot be inverted or scales unevenly, and for
/// skins that bind a joint at positions farther apart than 0.1 % of the skeleton's size.
GltfBindPose gltf_bind_pose(const CheckedGltf& gltf);

/// "joint 'hip' (node 3)"
std::string joint_words(const GltfDocument& document, int node);

}  // namespace sinew

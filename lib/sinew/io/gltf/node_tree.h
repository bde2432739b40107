// SPDX-License-Identifier: GPL-3.0-or-later
// The hierarchy and transforms of a glTF file's nodes, and the bind pose of its skins: the
// transforms of their joints and meshes at rest.
//
//     const GltfBindPose bind = gltf_bind_pose(checked_gltf("fox.glb"));
//
// A skin's inverse bind matrices I_j map its mesh's space to that of each joint j, so that in mesh
// space joint j was bound at I_j^-1. A file does not say how mesh space maps to the scene; here it
// is M = G I of the skin's topmost joint that scales as most do (some exporters add a root outside
// of the armature's scale, which rests where its node does), with G the joint's transform in the
// scene by the nodes: the body is bound at its topmost joint, at the scene's scale whatever units
// the mesh is in. The transform of a joint at bind is M I_j^-1. Skins that share joints are one
// skeleton, placed by the first of them. A skin whose joints have all the same inverse bind matrix,
// or none, is bound where its nodes rest. In general a joint at bind B_j takes a vertex to B_j I_j:
// where that is not M, as of meshes bound in another pose, vertices are blended by their weights.
//
// Bones without a skin are animated nodes that hold meshes. They are bound at their place below
// the nearest bone above as it rests, and so are meshes without a skin. In a file without skins the
// topmost node is a bone for what no animation moves.
//
// Joints bound with uneven scale turn by the nearest rotation (polar decomposition).
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
  Affine bind = Affine::Identity();  ///< in the scene
};

struct GltfBindPose {
  /// Joints of all skins in use, and animated nodes that hold meshes, each once, depth first.
  std::vector<GltfJoint> joints;
  std::vector<Affine> nodes;   ///< places of all nodes, those below joints as these are bound
  std::vector<int> holders;    ///< for each node the joint that its mesh follows, -1 for none
  std::vector<Affine> meshes;  ///< transform M of each skin's meshes
  /// B I of each skin's joints where vertices are blended, else none.
  std::vector<std::vector<Affine>> carried;
  /// Indices of each skin's joints in `joints`; none for a skin that is not in use.
  std::vector<std::vector<int>> places;
  std::string warning;  ///< about uneven scale, or ""
};

/// The skins that move a mesh of the scene; all where none does. Throws bad input (without the
/// path) for a bind matrix that is not finite or cannot be inverted.
GltfBindPose gltf_bind_pose(const CheckedGltf& gltf);

/// Whether the bind pose has joints.
bool has_bones(const CheckedGltf& gltf);

/// "joint 'hip' (node 3)"
std::string joint_words(const GltfDocument& document, int node);

}  // namespace sinew

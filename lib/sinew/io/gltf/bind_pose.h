// SPDX-License-Identifier: GPL-3.0-or-later
// The pose in which a glTF file's skins were bound: where their joints and meshes stand at rest.
//
// A skin's inverse bind matrices I_j take its mesh's own space to that of each joint j, so that in
// that space joint j was bound at I_j^-1. A file does not say where the mesh's space lies in the
// scene; here M = G I of the skin's topmost joint puts it, G being the joint's place in the scene
// as the nodes stand: the body is bound where its topmost joint stands, at the scene's scale
// whatever units the mesh is in. A joint's place at bind is M I_j^-1. Skins that share joints are
// one skeleton, bound where the first of them puts it.
#pragma once

#include <string>
#include <vector>

#include <sinew/io/gltf/guard.h>
#include <sinew/io/gltf/node_tree.h>

namespace sinew {

struct GltfJoint {
  int node = -1;
  int parent = -1;                   ///< the nearest joint above, an earlier one; -1 for none
  Affine bind = Affine::Identity();  ///< in the scene; scales evenly, to 1 %
};

struct GltfBindPose {
  std::vector<GltfJoint> joints;  ///< of all skins in use, each once, depth first
  std::vector<Affine> meshes;     ///< of each skin, where its meshes stand: M
  /// Of each skin, which of `joints` its joints are; none for a skin that is not in use.
  std::vector<std::vector<int>> places;
};

/// The skins that move a mesh of the scene; all where none does. Throws bad input (without the
/// path) for a bind matrix that is not finite, cannot be inverted or scales unevenly, and for
/// skins that bind a joint at places further apart than 0.1 % of the skeleton's size.
GltfBindPose gltf_bind_pose(const GuardedGltf& gltf, const GltfTree& tree);

/// "joint 'hip' (node 3)"
std::string joint_words(const GltfDocument& document, int node);

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// Reads skeletons, motions and skinned meshes from glTF 2.0 files, .gltf and .glb.
//
//     const SkinnedRig fox = read_gltf_rig("fox.glb");
//
// Bones are the joints of all skins that move a mesh of the default scene (of all skins where none
// does), and animated nodes that hold meshes, each node once; their rest is the bind pose, placed
// and scaled in the scene as node_tree.h says. Their tails are those of <sinew/rig/skeleton.h>; a
// joint "x" ends at its child node "x_end", as Blender names ends; without one, and without joints
// below it, at its only child node, if that has no mesh. Every animation is a clip; those without a
// name that are equally long and move other nodes each are one. Keys are kept; where that is
// impossible (scale, moving nodes between joints) the bone is sampled, as joint_motion.h says.
// Bones are rigid: scale that changes over time moves the heads below it, but changes no size;
// Motion::ignored_scales has it. Stretch is not used. Morph targets are ignored.
#pragma once

#include <filesystem>

#include <sinew/rig/skinning.h>

namespace sinew {

struct GltfRigOptions {
  double samples_per_second = 60;  ///< between keys, of bones whose keys cannot be kept
};

/// Lengths in m. The mesh has the triangles and placement of read_gltf(), without those that have
/// no skin and no joint above; its weights are those of up to eight sets of four (JOINTS_0 to
/// JOINTS_7), none for a vertex whose weights are all zero. Throws bad input, with the path, for
/// all that read_gltf() refuses, files without bones, skinned meshes without weights, and
/// animations, weights and matrices that are damaged.
SkinnedRig read_gltf_rig(const std::filesystem::path& path, const GltfRigOptions& options = {});

/// The skeleton of one file with the clips of another, which move the joints of the same names: as
/// in their file against the joint above, but below the topmost joints with the skeleton's own
/// lengths, unless these change by over 1 %. Warnings list nodes that the skeleton lacks, and
/// joints that no clip moves. Throws bad input as above, and for clips that move none of the
/// joints.
Rig read_gltf_clips(const std::filesystem::path& skeleton, const std::filesystem::path& clips,
                    const GltfRigOptions& options = {});

/// Whether the file has bones. Throws bad input for a damaged file.
bool has_gltf_rig(const std::filesystem::path& path);

}  // namespace sinew

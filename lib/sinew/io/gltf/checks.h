// SPDX-License-Identifier: GPL-3.0-or-later
// Reads a glTF file and checks every count, offset and index in it.
//
//     const CheckedGltf gltf = checked_gltf("fox.glb");
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <sinew/io/gltf/document.h>
#include <sinew/io/gltf/node_tree.h>

namespace sinew {

/// A consistent document. Every index refers to an element; every element lies in its view, every
/// view in `bytes`; nodes form trees of moderate depth. Positions are VEC3 of floats or of up to 16
/// bits, those of morph targets as many; corners whole numbers, as many as their mode requires.
/// Skins have a bind matrix for every joint and surfaces joints and weights for every vertex, if
/// any; animations have values for every time. The numbers themselves (corners, coordinates, times,
/// weights) are not checked.
struct CheckedGltf {
  GltfDocument document;    ///< no buffers: the views' offsets count from the start of `bytes`
  std::vector<char> bytes;  ///< all buffers, below 2 GiB
  GltfTree tree;            ///< tree of all nodes
  std::vector<int> shown;   ///< the nodes of the default scene, parents first
};

/// Reads a .gltf with its buffers, or a .glb; what Blender has to convert (converted.h) by way of
/// one. Buffers are taken from data URIs and from files in
/// the folder of `path` or below. Throws bad input, with the path.
CheckedGltf checked_gltf(const std::filesystem::path& path);

// The checks for rigs. All throw bad input without the path, naming the faulty element:
// "accessors[3]".

/// Indices exist; joints are nodes, each once; there are enough inverse bind matrices; surfaces
/// have joints and weights of the right type for every vertex. Accessors and meshes must be
/// checked.
void check_gltf_skins(const GltfDocument& document);

/// Indices exist; times and values are of the right type and number; no property of a node follows
/// two samplers. Channels that move no node are dropped.
void check_gltf_animations(GltfDocument& document);

/// The accessor of that index, which must exist. `user` is a plural: "its times". Without data it
/// is of zeros, a million at most.
const GltfAccessor& accessor_of(const GltfDocument& document, int index, const std::string& user);

/// Calls visit(primitive, "meshes[1].primitives[2]") for all of the file.
template <class Visit>
void for_each_primitive(const GltfDocument& document, const Visit& visit) {
  for (std::size_t i = 0; i < document.meshes.size(); ++i) {
    const auto& primitives = document.meshes[i].primitives;
    for (std::size_t k = 0; k < primitives.size(); ++k)
      visit(primitives[k], nth("meshes", i) + '.' + nth("primitives", k));
  }
}

}  // namespace sinew

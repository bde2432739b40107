// SPDX-License-Identifier: GPL-3.0-or-later
// A glTF file whose numbers can be believed: every count, offset and index of it has been looked
// at.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <sinew/io/gltf/document.h>
#include <sinew/io/gltf/node_tree.h>

namespace sinew {

/// A document that holds together. Every index points at something; every element lies in its
/// view, every view in `bytes`; nodes form trees of moderate depth. Positions are VEC3 of floats,
/// corners whole numbers, as many as their mode wants. Skins have a bind matrix for every joint and
/// surfaces joints and weights for every vertex, if any; animations have values for every time.
/// What the numbers are (corners, coordinates, times, weights) is not looked at.
struct CheckedGltf {
  GltfDocument document;    ///< no buffers: the views' offsets count from the start of `bytes`
  std::vector<char> bytes;  ///< all buffers, below 2 GiB
  GltfTree tree;            ///< of all nodes
  std::vector<int> shown;   ///< the nodes of the default scene, parents first
};

/// Reads a .gltf with its buffers, or a .glb. Buffers are taken from data URIs and from files in
/// the folder of `path` or below. Throws bad input, with the path.
CheckedGltf checked_gltf(const std::filesystem::path& path);

/// The parts of the check that rigs need. All checks throw bad input without the path, and name the
/// element at fault: "accessors[3]".

/// Indices exist; joints are nodes, each once; inverse bind matrices are enough; surfaces have
/// joints and weights of the right kind for every vertex. Accessors and meshes are checked before.
void check_gltf_skins(const GltfDocument& document);

/// Indices exist; times and values are of the right kind and as many as each other; no property of
/// a node follows two samplers. Channels that move no node are dropped.
void check_gltf_animations(GltfDocument& document);

/// The accessor of that index, which must exist and have data. `user` is a plural: "its times".
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

// SPDX-License-Identifier: GPL-3.0-or-later
// A look at a glTF file before VTK sees it: VTK believes every count, offset and index.
#pragma once

#include <filesystem>
#include <vector>

#include <sinew/io/gltf/document.h>

namespace sinew {

/// A document that holds together. Every index points at something; every element lies in its
/// view, every view in `bytes`; nodes form trees of moderate depth. Positions are VEC3 of floats,
/// corners whole numbers, as many as their mode wants. Skins have a bind matrix for every joint and
/// surfaces joints and weights for every vertex, if any; animations have values for every time.
/// What the numbers are (corners, coordinates, times, weights) is not looked at.
struct GuardedGltf {
  /// One scene is left, the default one, and of meshes the surfaces it shows; no buffers: the
  /// views' offsets count from the start of `bytes`.
  GltfDocument document;
  std::vector<char> bytes;  ///< all buffers, below 2 GiB
  std::vector<int> shown;   ///< the nodes of the scene, parents first
};

/// Reads a .gltf with its buffers, or a .glb. Buffers are taken from data URIs and from files in
/// the folder of `path` or below. Throws bad input, with the path.
GuardedGltf guarded_gltf(const std::filesystem::path& path);

}  // namespace sinew

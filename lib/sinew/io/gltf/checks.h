// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of the guard over glTF files. All throw bad input without the path, and name the
// element at fault: "accessors[3]".
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <sinew/core/error.h>
#include <sinew/io/gltf/guard.h>

namespace sinew {

/// glTF 2, and no extension required that changes shapes.
void check_gltf_version(const GltfDocument& document);

/// Every view lies in its buffer; then the buffers become one: views count from its start.
void join_gltf_buffers(GltfDocument& document);

/// Every accessor lies in its view, if it has one.
void check_gltf_accessors(const GltfDocument& document);

/// The indices of sparse accessors (checked before) are within them.
void check_gltf_sparse(const GuardedGltf& gltf);

/// Indices exist; positions and corners of surfaces have data of the right kind.
void check_gltf_meshes(const GltfDocument& document);

/// Indices exist; nodes form trees of moderate depth; the default scene, the only one that is left
/// (all roots where there is none), holds roots, each once.
void check_gltf_nodes(GltfDocument& document);

/// Indices exist; joints are nodes, each once; inverse bind matrices are enough; surfaces have
/// joints and weights of the right kind for every vertex. Accessors and meshes are checked before.
void check_gltf_skins(const GltfDocument& document);

/// Indices exist; times and values are of the right kind and as many as each other; no property of
/// a node follows two samplers. Channels that move no node are dropped.
void check_gltf_animations(GltfDocument& document);

/// The accessor of that index, which must exist and have data. `user` is a plural: "its times".
const GltfAccessor& accessor_of(const GltfDocument& document, int index, const std::string& user);

inline Error damaged_gltf(const std::string& what) { return bad_input(what, "export it again"); }

/// nth("nodes", 3) is "nodes[3]".
inline std::string nth(const char* what, std::size_t index) {
  return std::string(what) + '[' + std::to_string(index) + ']';
}

template <class Element>
void check_index(int index, const std::vector<Element>& elements, const std::string& user,
                 const char* what) {
  if (index < 0 || static_cast<std::size_t>(index) >= elements.size())
    throw damaged_gltf(user + " names " + what + ' ' + std::to_string(index) + " of " +
                       std::to_string(elements.size()));
}

/// Whether indices may be given in such numbers.
inline bool counts(GltfNumber number) {
  return number == GltfNumber::uint8 || number == GltfNumber::uint16 ||
         number == GltfNumber::uint32;
}

}  // namespace sinew

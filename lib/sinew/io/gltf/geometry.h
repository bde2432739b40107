// SPDX-License-Identifier: GPL-3.0-or-later
// The triangles of glTF 2.0 files, .gltf and .glb, placed in the scene.
//
//     const PolygonSoup soup = read_gltf("fox.glb");
#pragma once

#include <filesystem>
#include <vector>

#include <sinew/core/triangles.h>
#include <sinew/io/gltf/checks.h>

namespace sinew {

/// The triangles of the file's default scene (its first one where it names none, every node where
/// it has none), in meters, y up, as in the file. Meshes are placed by their nodes; the triangles
/// of mirrored ones are reversed, so that outsides stay outside. A skinned mesh is taken in its
/// bind pose and placed as node_tree.h says: its node does not move it. Strips and fans become
/// triangles; points, lines and unused vertices are left out, equal vertices stay separate.
///
/// Throws bad input, with the path, for a file of another kind, that is damaged, holds no
/// triangles, has 2 GiB or more, or needs an extension that changes shapes (compression,
/// instancing).
PolygonSoup read_gltf(const std::filesystem::path& path);

/// A node of the scene that has a mesh, and the mesh's placement.
struct GltfShape {
  int node = -1;
  Affine place = Affine::Identity();
};

/// The origin of a vertex.
struct GltfVertex {
  int node = -1;
  int primitive = 0;  ///< primitive of the node's mesh
  int vertex = 0;     ///< vertex of that primitive's accessors
};

struct GltfTriangles {
  PolygonSoup soup;                 ///< n vertices, m
  std::vector<GltfVertex> sources;  ///< n
};

/// Returns shapes of the default scene, at rest: skinned ones in their bind pose.
std::vector<GltfShape> gltf_shapes(const CheckedGltf& gltf);

/// All shapes in order, as read_gltf() says. Throws bad input (without the path) for too many
/// triangles, corners that do not exist and coordinates that are not finite.
GltfTriangles gltf_triangles(const CheckedGltf& gltf, const std::vector<GltfShape>& shapes);

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// The triangles of glTF 2.0 files, .gltf and .glb, put where they belong.
#pragma once

#include <filesystem>
#include <vector>

#include <sinew/core/triangles.h>
#include <sinew/io/gltf/checks.h>

namespace sinew {

/// The triangles of the file's default scene (its first one where it names none, every node where
/// it has none), in meters, y up, as the file has them. Meshes stand where their nodes place them,
/// mirrored ones with their triangles turned so that outsides stay outside. A skinned mesh is taken
/// in its bind pose, put into the scene as node_tree.h says: its node does not move it. Strips and
/// fans become triangles; points and lines are left out. Vertices no triangle uses are left out,
/// equal ones stay apart.
///
/// Throws bad input, with the path, for all that is not such a file, is damaged, holds no
/// triangles, has 2 GiB or more, or needs an extension that changes shapes (compression,
/// instancing).
PolygonSoup read_gltf(const std::filesystem::path& path);

/// A node of the scene that has a mesh, and where that stands.
struct GltfShape {
  int node = -1;
  Affine place = Affine::Identity();
};

/// Where a vertex comes from.
struct GltfVertex {
  int node = -1;
  int primitive = 0;  ///< of the node's mesh
  int vertex = 0;     ///< of that primitive's accessors
};

struct GltfTriangles {
  PolygonSoup soup;                 ///< n vertices, m
  std::vector<GltfVertex> sources;  ///< n
};

/// One shape after the other, as read_gltf says. Throws bad input (without the path) for too many
/// triangles, corners that are not there and coordinates that are not finite.
GltfTriangles gltf_triangles(const CheckedGltf& gltf, const std::vector<GltfShape>& shapes);

}  // namespace sinew

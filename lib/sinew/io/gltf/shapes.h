// SPDX-License-Identifier: GPL-3.0-or-later
// The triangles of a glTF file's meshes, put where they belong, by VTK's loader.
#pragma once

#include <vector>

#include <sinew/core/triangles.h>
#include <sinew/io/gltf/guard.h>
#include <sinew/io/gltf/node_tree.h>

namespace sinew {

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

/// One shape after the other. Mirrored ones have their triangles turned so that outsides stay
/// outside; strips and fans become triangles; vertices that no triangle uses are left out, equal
/// ones stay apart. Throws bad input (without the path) for too many triangles, corners that are
/// not there and coordinates that are not finite.
GltfTriangles gltf_triangles(const GuardedGltf& gltf, const std::vector<GltfShape>& shapes);

}  // namespace sinew

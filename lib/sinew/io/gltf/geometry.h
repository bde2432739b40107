// SPDX-License-Identifier: GPL-3.0-or-later
// The triangles of glTF 2.0 files, .gltf, .glb and .vrm, placed in the scene.
//
//     const PolygonSoup soup = read_gltf("fox.glb");
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <sinew/core/triangles.h>
#include <sinew/io/gltf/checks.h>
#include <sinew/io/gltf/converted.h>

namespace sinew {

/// The triangles of the file's default scene (its first one where it names none, every node where
/// it has none), in meters, y up, as in the file. Meshes are placed by their nodes, those below a
/// joint where it was bound; the triangles of mirrored ones are reversed, so that outsides stay
/// outside. A skinned mesh is taken in its bind pose and placed as node_tree.h says: its node does
/// not move it. Morph targets have their weights at rest; a warning tells of animations of them.
/// Strips and fans become triangles; points, lines and unused vertices are left out, equal vertices
/// stay separate.
///
/// Throws bad input, with the path, for a file of another kind, that is damaged, holds no
/// triangles, has 2 GiB or more, or needs an extension that changes shapes and is not read
/// (instancing).
PolygonSoup read_gltf(const std::filesystem::path& path);

/// The names of the nodes, or else of their meshes, whose surfaces the scene shows. Throws bad
/// input as above for a damaged file.
std::vector<std::string> gltf_mesh_names(const std::filesystem::path& path);

/// The triangles of these meshes alone, by those names. Throws bad input, with the path, for a name
/// that is not there.
PolygonSoup read_gltf_meshes(const std::filesystem::path& path,
                             const std::vector<std::string>& names);

/// A node of the scene that has a mesh, and the mesh's placement.
struct GltfShape {
  int node = -1;
  Affine place = Affine::Identity();
  std::vector<Affine> carried;  ///< in place of it, by joints of its skin, blended; or none
  int joint = -1;               ///< the joint that a mesh without skin follows, -1 for none
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
std::vector<GltfShape> gltf_shapes(const CheckedGltf& gltf, const GltfBindPose& bind);
std::vector<GltfShape> gltf_shapes(const CheckedGltf& gltf);

/// All shapes in order, as read_gltf() says. Throws bad input (without the path) for too many
/// triangles, corners that do not exist and coordinates that are not finite.
GltfTriangles gltf_triangles(const CheckedGltf& gltf, const std::vector<GltfShape>& shapes);

}  // namespace sinew

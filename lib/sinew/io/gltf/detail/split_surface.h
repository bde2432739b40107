// SPDX-License-Identifier: GPL-3.0-or-later
// A surface whose vertices have one value of each attribute, as glTF requires: its points are split
// where texture coordinates, normals or other values of their faces differ.
//
//     const SplitSurface split = split_surface(faces, points, look);
//     MovedNormals normals(split, xyz_at_rest);
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <sinew/core/surface_look.h>
#include <sinew/core/triangles.h>

namespace sinew {

struct SplitSurface {
  /// Faces of one material.
  struct Patch {
    std::string material;                ///< its name, or empty
    int gltf_material = -1;              ///< in the look's, if any
    std::vector<std::uint32_t> corners;  ///< vertices, three for each face
  };

  std::vector<int> point;                  ///< point of each vertex
  std::vector<std::size_t> smooth;         ///< index of each vertex's normal
  Points normals;                          ///< normals given, in the scene's axes; zero: none
  bool has_normals = false;                ///< whether any is given
  std::vector<float> coordinates;          ///< u v of each vertex, v downward; empty: none
  std::vector<SurfaceLook::Layer> layers;  ///< layers of the vertices
  std::vector<Patch> patches;
};

/// `look` of the faces, or an empty one: then the vertices are the points, in their order.
SplitSurface split_surface(const std::vector<std::array<int, 3>>& faces, std::size_t points,
                           const SurfaceLook& look);

/// Normals of a surface that moves: those given, turned as the mean of the faces turns that they
/// belong to, so that what is smooth or sharp at rest stays so.
class MovedNormals {
 public:
  /// `at_rest`: x y z of each vertex; `given`: normals in the same axes, zero where none is.
  MovedNormals(const SplitSurface& surface, const std::vector<float>& at_rest, Points given);

  /// x y z of each vertex's normal where the vertices are at `places`.
  std::vector<float> at(const std::vector<float>& places) const;

 private:
  Points means(const std::vector<float>& places) const;

  const SplitSurface& surface_;
  Points given_, at_rest_;
};

}  // namespace sinew

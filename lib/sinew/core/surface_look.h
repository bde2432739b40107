// SPDX-License-Identifier: GPL-3.0-or-later
// What a mesh file says of its surface beside the shape: texture coordinates, normals, groups and
// materials.
//
//     write_obj("surface.obj", surface, look);
#pragma once

#include <array>
#include <string>
#include <vector>

#include <sinew/core/vector.h>

namespace sinew {

/// The materials of a glTF file as it describes them.
struct GltfMaterials {
  /// Object of materials, textures, samplers, images, extensionsUsed; or none.
  std::string json;
  std::vector<std::string> images;  ///< the bytes of those whose bufferView is an index here
};

struct SurfaceLook {
  /// Consecutive faces in a file; names are empty where it has none.
  struct Part {
    std::string object, group, material;
    int gltf_material = -1;  ///< index in `gltf`
  };
  /// Another value of vertices, by glTF's name: "TEXCOORD_1", "COLOR_0".
  struct Layer {
    std::string name;
    int components = 2;
    std::vector<float> values;
  };
  /// Described in one of the libraries.
  struct Material {
    std::string name;
    std::array<double, 3> color{1, 1, 1};  ///< red, green, blue
    double opacity = 1;
    std::string image;  ///< path of the texture over the color, or empty
  };
  using Corners = std::array<int, 3>;  ///< indices into coordinates for a face, -1 for none

  std::vector<std::array<double, 2>> coordinates;  ///< u to the right, v up
  std::vector<Corners> corners;                    ///< per face: coordinates of each
  std::vector<int> part;                           ///< per face: index in parts, -1 for none
  std::vector<Part> parts;
  std::vector<std::string> libraries;        ///< paths of the files that describe the materials
  Points normals = {};                       ///< unit vectors
  std::vector<Corners> normal_corners = {};  ///< per face: normals of each
  std::vector<Layer> layers = {};
  std::vector<Corners> layer_corners = {};  ///< per face: elements of all layers
  GltfMaterials gltf = {};
  std::vector<Material> materials = {};
};

/// A vector of any size made one of length 1; zero stays zero.
inline Vec3 direction_of(const Vec3& vector) {
  const double largest = vector.cwiseAbs().maxCoeff();
  return largest > 0 ? Vec3((vector / largest).normalized()) : Vec3(Vec3::Zero());
}

/// The same of polygons.
struct PolygonLook {
  using Corners = std::vector<std::vector<int>>;  ///< per polygon and corner, -1 for none

  SurfaceLook look;                                ///< `part` is per polygon; without corners
  Corners corners, normal_corners, layer_corners;  ///< empty: none
};

}  // namespace sinew

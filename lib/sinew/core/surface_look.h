// SPDX-License-Identifier: GPL-3.0-or-later
// What a mesh file says of its surface beside the shape: texture coordinates, groups and materials.
//
//     write_obj("surface.obj", surface, look);
#pragma once

#include <array>
#include <string>
#include <vector>

namespace sinew {

struct SurfaceLook {
  /// Of consecutive faces in a file; names are empty where it has none.
  struct Part {
    std::string object, group, material;
  };

  std::vector<std::array<double, 2>> coordinates;  ///< u v
  std::vector<std::array<int, 3>> corners;         ///< per face: coordinates of each, -1 for none
  std::vector<int> part;                           ///< per face: index in parts, -1 for none
  std::vector<Part> parts;
  std::vector<std::string> libraries;  ///< paths of the files that describe the materials
};

}  // namespace sinew

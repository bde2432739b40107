// SPDX-License-Identifier: GPL-3.0-or-later
// The header of a PLY file: the elements and properties in its body, and their number types.
//
//     const PlyHeader header = ply_header(open_mesh("part.ply"));
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <sinew/mesh/detail/readers/mesh_readers.h>

namespace sinew {

enum class PlyEncoding { ascii, little, big };

struct PlyType {
  std::string_view name;   ///< char, uchar, short, ushort, int, uint, float, double
  std::string_view other;  ///< int8 and so on: the same type's second name
  int bytes;
  bool real;               ///< float or double
  std::int64_t low, high;  ///< limits of an integer type
};

struct PlyProperty {
  std::string name;
  const PlyType* type;
  const PlyType* count = nullptr;  ///< the type of a list's length; nullptr for single numbers
  int axis = -1;                   ///< axis of a vertex's coordinate: 0, 1, 2
  bool corners = false;            ///< whether it is the list of a face's corners
};

struct PlyElement {
  std::string name;
  std::int64_t count;
  std::vector<PlyProperty> properties;

  bool vertices() const { return name == "vertex" || name == "vertices"; }
  bool faces() const { return name == "face" || name == "faces"; }
  bool strips() const { return name == "tristrips"; }
  PlyProperty* find(std::string_view property);
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::ascii;
  std::vector<PlyElement> elements;
  std::size_t size = 0;  ///< bytes up to the body
  int lines = 0;
};

/// Reads and checks the header: vertices have x, y, z, faces a list of integers vertex_indices (or
/// vertex_index), and so do triangle strips; any other elements and properties are allowed.
PlyHeader ply_header(const MeshFile& file);

}  // namespace sinew

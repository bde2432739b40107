// SPDX-License-Identifier: GPL-3.0-or-later
// The table of mesh formats, from which reading, error messages and help texts come. To add a
// format, write its reader (mesh_readers.h) and add its row; one that needs another folder's reader
// has its row where both are known (tools/scene/mesh_input.cpp).
#pragma once

#include <span>
#include <string>
#include <string_view>

#include <sinew/core/triangles.h>

namespace sinew {

struct MeshFormat {
  std::string_view name;       ///< "OBJ"
  std::string_view extension;  ///< ".obj", in small letters
  PolygonSoup (*read)(const std::string& path);
  /// Whether a file's first words say that it is of this format; none: they never do.
  bool (*recognizes)(std::string_view content) = nullptr;
};

/// "OBJ, OFF, STL, PLY", and the names of `more`.
std::string mesh_format_names(std::span<const MeshFormat> more = {});

/// What the file holds, unchanged: at least one face, corners that exist, finite coordinates. The
/// format comes from the extension, in any case; `more` are read beside OBJ, OFF (text), STL and
/// PLY (text and binary). Throws Error (bad input) naming file, line where there is one, fault and
/// cure, also where the first words tell of another format than the extension.
PolygonSoup read_polygons(const std::string& path, std::span<const MeshFormat> more = {});

}  // namespace sinew

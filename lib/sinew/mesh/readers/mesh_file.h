// SPDX-License-Identifier: GPL-3.0-or-later
// The content of a mesh file, and its errors with path and line.
//
//     const MeshFile file = open_mesh("part.obj");
#pragma once

#include <string>
#include <string_view>

#include <sinew/core/error.h>

namespace sinew {

struct MeshFile {
  std::string path;
  std::string content;

  /// The error "PATH:LINE: what; cure"; line 0 where there are no lines.
  Error broken(int line, const std::string& what, const std::string& cure) const;
};

/// Throws Error (bad input) unless it is a non-empty regular file that fits into memory.
void check_mesh_file(const std::string& path);

/// Reads such a file, without its byte order mark. Throws Error (bad input) also where it cannot be
/// read.
MeshFile open_mesh(const std::string& path);

}  // namespace sinew

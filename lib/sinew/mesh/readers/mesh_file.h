// SPDX-License-Identifier: GPL-3.0-or-later
// A mesh file's bytes, taken in once, and which format they claim to be in.
#pragma once

#include <string>
#include <string_view>

#include <sinew/core/error.h>

namespace sinew {

enum class MeshFormat { obj, off, stl, ply };

struct MeshFile {
  std::string path;
  MeshFormat format;
  std::string content;

  /// The error "PATH:LINE: what; cure"; line 0 where there are no lines.
  Error broken(int line, const std::string& what, const std::string& cure) const;
};

/// Reads `path` whole. The format comes from the extension (any case) and must not be contradicted
/// by the first word. Throws Error (bad input) for anything but a readable, non-empty regular file.
MeshFile open_mesh(const std::string& path);

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// CGAL's readers trip over much that mesh files contain: unknown keywords, tabs, continued lines,
// "solid" headers of binary files, counts that do not fit, indices out of range. Here each format
// is checked once from end to end and brought into the plain form that CGAL reads without surprise.
// Numbers are passed on as they were written.
#pragma once

#include <string>

#include "mesh/mesh_file.h"

namespace sinew {

/// All four throw Error (bad input) with the file, the line where there is one, what is wrong and
/// what to do. No count in a file is believed before its bytes have been seen.

/// Wavefront OBJ: only its `v` and `f` lines, indices positive, continued lines joined.
std::string plain_obj(const MeshFile& file);

/// Geomview OFF (also with colours, normals, texture coordinates; text only): positions and
/// corners.
std::string plain_off(const MeshFile& file);

/// STL, text or binary.
std::string plain_stl(const MeshFile& file);

/// Stanford PLY, text or binary of either byte order: header in canonical form, the same body.
std::string plain_ply(const MeshFile& file);

/// The one for the file's format.
std::string plain_mesh(const MeshFile& file);

}  // namespace sinew

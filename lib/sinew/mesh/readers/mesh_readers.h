// SPDX-License-Identifier: GPL-3.0-or-later
// The readers of mesh formats, each file read once from end to end and checked on the way. What
// mesh files contain makes most readers trip: unknown keywords, tabs, continued lines, "solid"
// headers of binary files, counts that do not fit, indices out of range.
#pragma once

#include <sinew/core/triangles.h>
#include <sinew/mesh/readers/mesh_file.h>
#include <sinew/mesh/readers/mesh_text.h>

namespace sinew {

/// All throw Error (bad input) with the file, the line where there is one, what is wrong and what
/// to do. No count in a file is believed before its bytes have been seen. What they give has faces
/// of three corners or more, corners that exist and finite coordinates.

/// Wavefront OBJ: `v` and `f` lines with indices of either sign, continued lines joined.
PolygonSoup read_obj(const MeshFile& file);

/// Geomview OFF (also with colors, normals, texture coordinates; text only).
PolygonSoup read_off(const MeshFile& file);

/// STL, text or binary: three points of its own for each triangle.
PolygonSoup read_stl(const MeshFile& file);

/// Stanford PLY, text or binary of either byte order.
PolygonSoup read_ply(const MeshFile& file);

/// The next three words as coordinates.
Vec3 next_point(Words& words, const MeshFile& file);

/// Refuses more points than faces can name, which are int.
void refuse_too_many_points(const MeshFile& file, std::size_t points);

}  // namespace sinew

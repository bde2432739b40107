// SPDX-License-Identifier: GPL-3.0-or-later
// The readers of mesh formats. Each checks the file while reading it once: unknown keywords, tabs,
// continued lines, "solid" headers of binary files, counts that do not fit, indices out of range.
//
//     const PolygonSoup soup = read_obj(open_mesh("part.obj"));
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <sinew/core/error.h>
#include <sinew/core/surface_look.h>
#include <sinew/core/triangles.h>
#include <sinew/mesh/detail/readers/mesh_text.h>

namespace sinew {

/// The content of a mesh file, and its errors with path and line.
struct MeshFile {
  std::string path;
  std::string content;

  /// The error "PATH:LINE: what; cure"; line 0 where there are no lines.
  Error broken(int line, const std::string& what, const std::string& cure) const;
};

/// Throws Error (bad input) unless it is a non-empty regular file that fits into memory.
void check_mesh_file(const std::string& path);

/// Reads such a file, without its byte order mark. Throws bad input also where it cannot be read.
MeshFile open_mesh(const std::string& path);

// All throw Error (bad input) naming the file, the line if any, the fault and the cure. Every count
// in a file is checked against its length. The result has faces of three corners or more (those of
// fewer are left out, with a warning), corners that exist and finite coordinates.

/// Wavefront OBJ: `v` and `f` lines with indices of either sign, continued lines joined; with
/// `look`, what else describes the surface.
PolygonSoup read_obj(const MeshFile& file);
PolygonSoup read_obj(const MeshFile& file, PolygonLook& look);

/// The materials of an MTL file beside an OBJ: color (Kd), opacity (d, Tr) and texture (map_Kd).
/// None where it cannot be read; what is no number is left out.
std::vector<SurfaceLook::Material> read_mtl(const std::string& path);

/// Geomview OFF (also with colors, normals, texture coordinates; text only), by lines or, where
/// they do not fit, by words: numbers in lines of any length.
PolygonSoup read_off(const MeshFile& file);

/// "OFF", "COFF" and so on; the number of vertices may follow without a blank.
bool is_off_keyword(std::string_view word);

/// STL, text or binary: three points of its own for each triangle.
PolygonSoup read_stl(const MeshFile& file);

/// Stanford PLY, text or binary of either byte order.
PolygonSoup read_ply(const MeshFile& file);

/// The next three words as coordinates.
Vec3 next_point(Words& words, const MeshFile& file);

/// Tells of so many faces of fewer than three corners that were left out; refuses where none is
/// left, or something else is wrong.
void tell_of_left_out(const MeshFile& file, std::size_t faces, PolygonSoup& soup);

/// Refuses more points than an int can index.
void refuse_too_many_points(const MeshFile& file, std::size_t points);

}  // namespace sinew

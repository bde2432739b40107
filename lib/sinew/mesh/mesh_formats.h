// SPDX-License-Identifier: GPL-3.0-or-later
// The table of mesh formats, from which reading, error messages and help texts are made. To add a
// format, write its reader (mesh_readers.h) and add its row; the rows of formats whose reader is in
// another folder are passed as `more` (<sinew/scene/body_mesh.h>).
//
//     const PolygonSoup soup = read_polygons("part.stl");
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <sinew/core/surface_look.h>
#include <sinew/core/triangles.h>

namespace sinew {

struct MeshFormat {
  std::string_view name;       ///< "OBJ"
  std::string_view extension;  ///< ".obj", in lower case
  PolygonSoup (*read)(const std::string& path);
  /// Whether the first words of a file identify the format; none: they never do.
  bool (*recognizes)(std::string_view content) = nullptr;
  /// The same polygons with their look; none: its files say nothing of it.
  PolygonSoup (*read_look)(const std::string& path, PolygonLook& look) = nullptr;
  /// The surface of an image at a value; none: its files hold no images.
  PolygonSoup (*read_level)(const std::string& path, double level) = nullptr;
};

/// "OBJ, OFF, STL, PLY" and the names of `more`.
std::string mesh_format_names(std::span<const MeshFormat> more = {});

/// Whether a path has the extension of one of the formats, in either case.
bool names_mesh(const std::string& path, std::span<const MeshFormat> more = {});

/// The polygons of a file, unchanged: at least one face, corners that exist, finite coordinates.
/// The extension, in either case, selects the format: OBJ, OFF (text), STL, PLY (text and binary)
/// or one of `more`. `level`: value at the surface, of formats that hold images. Throws Error (bad
/// input) naming file, line if any, fault and cure, also where the first words identify another
/// format than the extension, and where no image has the level.
PolygonSoup read_polygons(const std::string& path, std::span<const MeshFormat> more = {},
                          std::optional<double> level = {});

/// The polygons as a binary PLY in double: what read_polygons() gives has the same bits.
std::string ply_text(const PolygonSoup& soup);

/// A Wavefront OBJ with what else describes its surface. Throws Error (bad input), naming the file.
PolygonSoup read_obj_look(const std::string& path, PolygonLook& look);
/// The materials of an MTL file beside an OBJ: color (Kd), opacity (d, Tr) and texture (map_Kd).
/// None where it cannot be read; what is no number is left out.
std::vector<SurfaceLook::Material> read_materials(const std::string& path);

}  // namespace sinew

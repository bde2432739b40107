// SPDX-License-Identifier: GPL-3.0-or-later
// From a mesh file to a closed surface. Accepted: OBJ, OFF, STL (text and binary) and PLY (text and
// binary), told by the extension; lengths in metres.
#pragma once

#include <string>

#include "mesh/surface.h"
#include "core/polygon_soup.h"

namespace sinew {

/// What the file holds, unchanged: at least one face, corners that exist, finite coordinates.
/// Throws Error (bad input) naming file, line where there is one, fault and cure.
PolygonSoup read_polygons(const std::string& path);

/// The same, cleaned as mesh/clean.h says. Throws Error (bad input) for broken and open meshes too.
Surface read_surface(const std::string& path);

}  // namespace sinew

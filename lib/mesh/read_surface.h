// SPDX-License-Identifier: GPL-3.0-or-later
// From a mesh file to a surface. Files: OBJ, OFF (text), STL (text and binary) and PLY (text and
// binary), told by the extension; any other kind through a reader for it.
#pragma once

#include <functional>
#include <string>

#include "core/polygon_soup.h"
#include "core/settings.h"
#include "mesh/surface.h"

namespace sinew {

/// What the file holds, unchanged: at least one face, corners that exist, finite coordinates.
/// Throws Error (bad input) naming file, line where there is one, fault and cure.
PolygonSoup read_polygons(const std::string& path);

using MeshReader = std::function<PolygonSoup(const std::string& path)>;

/// What the reader finds at `body.mesh`, prepared as the settings ask (mesh/prepare.h), with the
/// time that took. Throws Error (bad input), naming the file.
Surface read_surface(const BodySettings& body, const MeshReader& reader = read_polygons);

}  // namespace sinew

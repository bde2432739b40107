// SPDX-License-Identifier: GPL-3.0-or-later
// From a mesh file to a surface. Files: OBJ, OFF (text), STL (text and binary) and PLY (text and
// binary), told by the extension; any other kind through a reader for it.
#pragma once

#include <functional>
#include <string>

#include <sinew/core/triangles.h>
#include <sinew/mesh/surface.h>
#include <sinew/core/options.h>

namespace sinew {

/// What the file holds, unchanged: at least one face, corners that exist, finite coordinates.
/// Throws Error (bad input) naming file, line where there is one, fault and cure.
PolygonSoup read_polygons(const std::string& path);

using MeshReader = std::function<PolygonSoup(const std::string& path)>;

/// What the reader finds at `body.mesh`, prepared as the settings ask (mesh/prepare.h), with the
/// time that took. Throws Error (bad input), naming the file.
Surface read_surface(const BodyOptions& body, const MeshReader& reader = read_polygons);

// From what a file holds to the surface that a body's settings ask for.

/// In meters, by unit and scale, and in the scene's directions, by up and forward; welded and cleaned; its holes closed, and replaced by a skin
/// around it, where the settings ask for that. Throws Error (bad input) where the soup has no
/// faces, faces of fewer than 3 corners, corners that are no points or coordinates that are not
/// finite, where the scale is not above 0, where closing holes leaves no face, and as clean() and
/// repair.h do.
Surface prepare(PolygonSoup soup, const BodyOptions& body);

}  // namespace sinew

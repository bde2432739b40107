// SPDX-License-Identifier: GPL-3.0-or-later
// From a mesh file to a surface.
//
//     BodyOptions body;
//     body.mesh = "part.stl";
//     body.unit = LengthUnit::mm;
//     const Surface surface = read_surface(body);
#pragma once

#include <span>

#include <sinew/core/options.h>
#include <sinew/mesh/readers/mesh_formats.h>
#include <sinew/mesh/surface.h>

namespace sinew {

/// The mesh at `body.mesh`, in any of the formats that read_polygons takes, prepared as the options
/// ask, with the time that took. Throws Error (bad input), naming the file.
Surface read_surface(const BodyOptions& body, std::span<const MeshFormat> more = {});

// From what a file holds to the surface that a body's settings ask for.

/// In meters, by unit and scale, and in the scene's directions, by up and forward; welded and
/// cleaned; its holes closed, and replaced by a skin around it, where the settings ask for that.
/// Throws Error (bad input) where the soup has no faces, faces of fewer than 3 corners, corners
/// that are no points or coordinates that are not finite, where the scale is not above 0, where
/// closing holes leaves no face, and as clean() and repair.h do.
Surface prepare(PolygonSoup soup, const BodyOptions& body);

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// Reads a mesh file and prepares it as the surface of a body.
//
//     BodyOptions body;
//     body.mesh = "part.stl";
//     body.unit = LengthUnit::mm;
//     const Surface surface = read_surface(body);
#pragma once

#include <span>

#include <sinew/core/options.h>
#include <sinew/core/surface_look.h>
#include <sinew/mesh/mesh_formats.h>
#include <sinew/mesh/surface.h>

namespace sinew {

/// The mesh at `body.mesh`, in any of the formats of read_polygons(), prepared by the options, with
/// the time taken. Throws Error (bad input), naming the file.
Surface read_surface(const BodyOptions& body, std::span<const MeshFormat> more = {});

/// The same of polygons that are there already: `body.mesh` is their name.
Surface read_surface(PolygonSoup soup, const BodyOptions& body);

/// Brings the points into the scene by placement_of(). Throws Error (bad input) where the scale is
/// not above 0.
void place(PolygonSoup& soup, const BodyOptions& body);

/// The surface from the polygons of a file: brought into the scene by placement_of(); welded and
/// cleaned; where the settings request it, its holes closed and the mesh replaced by a skin around
/// it. Throws Error (bad input) where the soup has no faces, faces of fewer than 3 corners, corners
/// that are not points or coordinates that are not finite, where the scale is not above 0, where
/// closing holes leaves no face, and as clean(), close_holes() and wrap() do.
Surface prepare(PolygonSoup soup, const BodyOptions& body);

/// The texture coordinates, normals, groups and materials of a file, for the surface made from it;
/// none of formats that have no look. Faces take the look of the polygon whose corners are in the
/// same places; new faces (of closed holes or a wrap) and those with welded corners have none.
/// Normals are turned into the scene. Throws bad input, naming the file, where it cannot be read.
SurfaceLook look_of(const BodyOptions& body, const Triangles& surface,
                    std::span<const MeshFormat> more = {});

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// The meshes of a scene or of the command line, ready to be filled: read by the room for its
// format, repaired if requested, cleaned.
//
//     const Surface surface = read_mesh(settings);
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <sinew/core/surface_look.h>
#include <sinew/core/vector.h>
#include <sinew/mesh/surface.h>
#include <sinew/settings/settings.h>

namespace sinew {

/// The formats, as help texts list them: "OBJ, OFF, STL, PLY, glTF, GLB, VRM, FBX, COLLADA, VTP,
/// VTU, VTK, VTI".
std::string mesh_formats();

/// Whether a path names a mesh, by its extension.
bool is_mesh(const std::filesystem::path& path);

/// Reads body.mesh with the options of the section body. Throws Error (bad input) that names the
/// file.
Surface read_body_mesh(const BodyOptions& body);
/// The same in a scene, which may hold the polygons itself (Settings::meshes).
Surface read_body_mesh(const BodyOptions& body, const Settings& scene);

/// Reads the meshes that a scene names, as one surface. Errors name the scene's line.
Surface read_mesh(const Settings& settings);
/// What the mesh's file says of the surface made from it, beside the shape.
SurfaceLook look_of_mesh(const Settings& settings, const Triangles& surface);

/// Returns the mesh in which each place of `rest` (m) lies: 0, or the number, from 1, of the last
/// of the scene's bodies that holds it.
std::vector<std::size_t> meshes_of_particles(const Settings& settings, const Surface& surface,
                                             const Points& rest);

/// Returns the stiffness around each place of `rest` (m), over the body's: of the last of the
/// scene's bodies in which it lies; empty: the same throughout.
std::vector<double> stiffness_of(const Settings& settings, const Surface& surface,
                                 const Points& rest);

/// The scene with the paths of files in `folder` for polygons that it holds, and still with these.
Settings with_mesh_files(Settings scene, const std::filesystem::path& folder);
/// Writes the polygons that a scene holds to the files that they are named after. Throws not
/// written.
void write_mesh_files(const Settings& scene);

}  // namespace sinew

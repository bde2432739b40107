// SPDX-License-Identifier: GPL-3.0-or-later
// The body of a scene: its mesh read, filled and ready to be written or simulated.
//
//     const Surface surface = read_mesh(settings);
//     const Filling filling = fill_body(settings, surface);
#pragma once

#include <filesystem>
#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include <sinew/core/surface_look.h>
#include <sinew/fill/pack.h>
#include <sinew/io/single_files.h>
#include <sinew/mesh/surface.h>
#include <sinew/scene/context.h>
#include <sinew/settings/settings.h>
#include <sinew/volume/volume_cells.h>

namespace sinew {

// The mesh of a scene or of the command line, ready to be filled: read by the room for its format,
// repaired if requested, cleaned.

/// The formats, as help texts list them: "OBJ, OFF, STL, PLY, glTF, GLB, VTP, VTU, VTK, VTI".
std::string mesh_formats();

/// Reads body.mesh with the options of the section body. Throws Error (bad input) that names the
/// file.
Surface read_body_mesh(const BodyOptions& body);
/// The same in a scene, which may hold the polygons itself (Settings::meshes).
Surface read_body_mesh(const BodyOptions& body, const Settings& scene);

/// Whether a path names a scene (by .yaml or .yml) rather than a mesh.
bool is_scene(const std::filesystem::path& path);

/// Throws bad input for a mesh or a BVH file, by its extension, where a scene is expected.
void refuse_mesh_as_scene(const std::string& path);

/// Throws bad input for an output that is there and a scene.
void refuse_to_replace_scene(const std::filesystem::path& output);

/// Throws Error (bad input) for an output of another extension, that is one of the inputs, or a
/// scene.
void refuse_output(const std::string& output, std::initializer_list<std::string> inputs,
                   const std::string& extension = ".vtu");

/// The axes of the packing, as columns.
Mat3 lattice_axes(const BodyOptions& body);

/// Reads the meshes that a scene names, as one surface. Errors name the scene's line.
Surface read_mesh(const Settings& settings);

/// Returns the mesh in which each place of `rest` (m) lies: 0, or the number, from 1, of the last
/// of the scene's bodies that holds it.
std::vector<std::size_t> meshes_of_particles(const Settings& settings, const Surface& surface,
                                             const Points& rest);

/// Returns the stiffness around each place of `rest` (m), over the body's: of the last of the
/// scene's bodies in which it lies; empty: the same throughout.
std::vector<double> stiffness_of(const Settings& settings, const Surface& surface,
                                 const Points& rest);
/// What the mesh's file says of the surface made from it, beside the shape.
SurfaceLook look_of_mesh(const Settings& settings, const Triangles& surface);

/// Fills it as the scene specifies. Errors name the scene's line. `verify`: checks every site
/// against CGAL.
Filling fill_body(const Settings& settings, const Surface& surface, bool verify = false);

/// The tetrahedra of its particles at `rest` (m, by id) with `radius` (m), up to the surface.
VolumeCells cells_of_body(const Settings& settings, const Surface& surface, const Points& rest,
                          double radius);

/// A value of the fill's report as JSON, which has null for numbers that are not finite.
nlohmann::ordered_json json_of(const ReportValue& value);

/// The contents of body.vtu for a filling; `origin` identifies its source.
BodyFile body_file(Filling filling, const std::string& origin = "");

/// Warnings of the filling that body.vtu keeps.
std::vector<std::string> fill_warnings(const BodyFile& body);

/// The scene with the paths of files in `folder` for polygons that it holds, and still with these.
Settings with_mesh_files(Settings scene, const std::filesystem::path& folder);
/// Writes the polygons that a scene holds to the files that they are named after. Throws not
/// written.
void write_mesh_files(const Settings& scene);

/// A text that is equal for the same mesh file filled with the same settings.
std::string origin_of(const Settings& settings);

/// The body of this scene, if `path` contains it.
std::optional<BodyFile> body_of_scene(const std::filesystem::path& path, const std::string& origin);

}  // namespace sinew

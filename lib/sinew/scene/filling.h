// SPDX-License-Identifier: GPL-3.0-or-later
// A scene's mesh filled with particles, and body.vtu, which keeps them.
//
//     const Filling filling = fill_body(settings, read_mesh(settings));
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <sinew/fill/pack.h>
#include <sinew/io/single_files.h>
#include <sinew/mesh/surface.h>
#include <sinew/settings/settings.h>
#include <sinew/volume/volume_cells.h>

namespace sinew {

/// The axes of the packing, as columns.
Mat3 lattice_axes(const BodyOptions& body);

/// Fills the mesh as the scene specifies. Errors name the scene's line. `verify`: checks every site
/// against CGAL.
Filling fill_body(const Settings& settings, const Surface& surface, bool verify = false);

/// The tetrahedra of its particles at `rest` (m, by id) with `radius` (m), up to the surface.
VolumeCells cells_of_body(const Settings& settings, const Surface& surface, const Points& rest,
                          double radius);

/// The contents of body.vtu for a filling; `origin` identifies its source.
BodyFile body_file(Filling filling, const std::string& origin = "");

/// Warnings of the filling that body.vtu keeps.
std::vector<std::string> fill_warnings(const BodyFile& body);

/// A text that is equal for the same mesh file filled with the same settings.
std::string origin_of(const Settings& settings);

/// The body of this scene, if `path` contains it.
std::optional<BodyFile> body_of_scene(const std::filesystem::path& path, const std::string& origin);

}  // namespace sinew

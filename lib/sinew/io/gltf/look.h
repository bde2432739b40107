// SPDX-License-Identifier: GPL-3.0-or-later
// What a glTF file says of its surface beside the shape.
//
//     PolygonLook look;
//     const PolygonSoup soup = read_gltf_look("fox.glb", look);
#pragma once

#include <filesystem>

#include <sinew/core/surface_look.h>
#include <sinew/core/triangles.h>

namespace sinew {

/// The triangles as read_gltf() gives them, with texture coordinates, normals (turned with their
/// nodes), further coordinates and colors of vertices, names of nodes and materials. Attributes of
/// another type or count than glTF requires are left out. Throws as read_gltf() does.
PolygonSoup read_gltf_look(const std::filesystem::path& path, PolygonLook& look);

}  // namespace sinew

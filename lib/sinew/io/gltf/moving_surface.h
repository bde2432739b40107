// SPDX-License-Identifier: GPL-3.0-or-later
// Writes a moving surface as one GLB for glTF viewers and modeling programs: the initial surface, a
// morph target for every later sample, and an animation that interpolates linearly between them
// (glTF 2.0, section 3.7.2.2), with the look of the mesh's file. Converted from the scene's axes, x
// forward and z up, to glTF's, z forward and y up; meters.
//
//     write_moving_surface("surface.glb", surface.faces, "surface.pc2", times, look);
#pragma once

#include <filesystem>
#include <span>

#include <sinew/core/surface_look.h>
#include <sinew/core/triangles.h>

namespace sinew {

/// `faces` of the points in `cache` (a PC2 of <sinew/io/point_cache.h>), whose samples are
/// of these `times` (s). Of more than 500 samples, or 1 GiB of them, every second, third, ... is
/// taken, and the last. Of the `look` of the faces, coordinates, normals, layers and materials are
/// written: vertices are split where these differ, and normals move with the faces around them.
/// `origin`: that of the cache (m), to which the surface's node is translated. Throws bad input
/// where `cache` is not a PC2, and not written.
void write_moving_surface(const std::filesystem::path& path,
                          const std::vector<std::array<int, 3>>& faces,
                          const std::filesystem::path& cache, std::span<const double> times,
                          const SurfaceLook& look = {}, const Vec3& origin = Vec3::Zero());

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// A moving surface as one GLB that viewers of glTF and modeling programs play: the surface as it
// begins, a morph target for every moment after that, and an animation that goes from one to the
// next in straight ways (glTF 2.0, section 3.7.2.2). Turned from the scene's directions, x forward
// and z up, to glTF's, z forward and y up; meters.
#pragma once

#include <filesystem>

#include <sinew/core/triangles.h>

namespace sinew {

/// `faces` of the points in `cache` (a PC2 of io/point_cache.h), whose samples lie `interval` s
/// apart. Of more than 500 samples, or 1 GiB of them, every second, third, ... is taken, and the
/// last. Throws bad input for a cache that is none, and not written.
void write_moving_surface(const std::filesystem::path& path,
                          const std::vector<std::array<int, 3>>& faces,
                          const std::filesystem::path& cache, double interval);

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// A small picture of the last moment of each of many runs, all by one camera and in one range of
// colors: DIR/picture.png.
//
//     write_small_pictures({"out/a", "out/b"}, 320, 240);
#pragma once

#include <filesystem>
#include <vector>

namespace sinew {

/// Particles in the colors of their displacements. Needs an X display. Throws what DrawnRun throws.
void write_small_pictures(const std::vector<std::filesystem::path>& runs, int width, int height);

}  // namespace sinew

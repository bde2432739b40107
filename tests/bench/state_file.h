// SPDX-License-Identifier: GPL-3.0-or-later
// Prepared states on disk, so that every program of a comparison starts from the same bits: 8-byte
// count, then x y z u v w of all particles as in memory, for the same machine.
#pragma once

#include <filesystem>

#include "bench/states.h"

namespace sinew::bench {

/// FOLDER/SHAPE_COUNT.state.
std::filesystem::path state_path(const std::filesystem::path& folder, Condition condition,
                                 std::size_t count);

/// Throws Error (not_written).
void write_state(const std::filesystem::path& path, const Particles& particles);

/// The scene's particles in the state of the file. Throws bad input when the file has another
/// number of particles or ends early.
Particles read_state(const std::filesystem::path& path, const Scene& scene);

}  // namespace sinew::bench

// SPDX-License-Identifier: GPL-3.0-or-later
// The particles of a frame, of which each rank writes a part into the same file, as a piece of it.
// Particles move from rank to rank, but those of a piece are the same ones in every frame: rank k
// of n writes the k-th n-th of all ids, so that one piece after the other they are in order.
//
//     write_frame_piece(file, setup, rows, moment);
#pragma once

#include <filesystem>
#include <vector>

#include <sinew/engine/engine_files.h>
#include <sinew/io/frames.h>

namespace sinew {

/// What is written of a particle; ranks send it to each other as it lies in memory.
struct PieceRow {
  std::int32_t id = 0, bone = 0, neighbors = 0, broken_bonds = 0;
  double weight = 0;
  Vec3 rest, position, velocity;        ///< m, m/s
  Vec3 pair, damping, on_bones, world;  ///< N
};

/// Called by all ranks, each with the rows of its own particles. The file's end is left to
/// Series::finish(). Throws not written.
void write_frame_piece(const std::filesystem::path& file, const EngineSetup& setup,
                       std::vector<PieceRow> rows, Moment moment);

}  // namespace sinew

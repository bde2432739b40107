// SPDX-License-Identifier: GPL-3.0-or-later
// What one rank knows of a body, by the local index of its particles: their rows, which LAMMPS
// moves along with them, and the forces of the present moment.
#pragma once

#include <cstdint>
#include <vector>

#include <sinew/engine/engine_files.h>
#include <sinew/engine/particle_rows.h>

namespace sinew {

/// LAMMPS counts particles from 1.
inline std::int32_t tag_of(std::int32_t id) { return id + 1; }
inline std::int32_t id_of(std::int32_t tag) { return tag - 1; }

struct LocalBody {
  explicit LocalBody(EngineSetup given) : setup(std::move(given)), width(setup.shape.size()) {}

  EngineSetup setup;
  std::size_t width;         ///< width of a row
  std::vector<double> rows;  ///< one row per local index
  Points pair, damping;      ///< on own particles, N
  Points bone, bone_damping;
  Points world;                   ///< empty without one
  std::vector<double> neighbors;  ///< how many, of ghosts too where damping is pairwise
  double longest_bond = 0;        ///< longest bond of own particles, m

  double* numbers(int i) { return rows.data() + static_cast<std::size_t>(i) * width; }
  ParticleRow row(int i) const {
    return {rows.data() + static_cast<std::size_t>(i) * width, setup.shape};
  }
};

}  // namespace sinew

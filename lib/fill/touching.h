// SPDX-License-Identifier: GPL-3.0-or-later
// Which of the filled sites are nearest neighbours of each other: they touch at 2r. Counted on the
// lattice, run against run, without looking at positions.
#pragma once

#include <cstdint>
#include <vector>

#include "fill/inside/inside_runs.h"

namespace sinew {

struct Touching {
  std::vector<std::int32_t> neighbours;  ///< per site of the runs, in their order: 0 to 12
  std::vector<std::int32_t> group;       ///< per run: sites that hang together, by their first run
  std::int32_t groups = 0;
};

/// Runs must be sorted by row and site. The same for every number of threads.
Touching touching_sites(const Lattice& lattice, const std::vector<Run>& runs);

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// Sets of lattice sites as runs of sites that follow each other in a row, and their algebra.
#pragma once

#include <cstdint>
#include <vector>

namespace sinew {

struct Run {
  std::int32_t row, first, last;  ///< sites first .. last - 1
  std::int32_t body;

  int sites() const { return last - first; }
  bool operator==(const Run&) const = default;
};

// All take runs sorted by row and then site, no two of one vector with a site in common, and give
// such runs; of those given, none touch with the same body. A site keeps the body it has in `runs`.

/// The sites of `runs` that are not in `others`.
std::vector<Run> runs_without(const std::vector<Run>& runs, const std::vector<Run>& others);

/// The sites of `runs` that are in `others`, too.
std::vector<Run> runs_within(const std::vector<Run>& runs, const std::vector<Run>& others);

}  // namespace sinew

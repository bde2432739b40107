// SPDX-License-Identifier: GPL-3.0-or-later
// Sets of lattice sites as runs of sites that follow each other in a row, and their difference.
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

/// The sites of `runs` that are not in `others`, with the body they have in `runs`. Both are sorted
/// by row and then site, no two runs of one with a site in common; so is what is given, in which
/// none touch with the same body.
std::vector<Run> runs_without(const std::vector<Run>& runs, const std::vector<Run>& others);

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// How often neighbor lists were made, and how long they are, as run.json and the log tell it.
#pragma once

#include <cstdint>

namespace sinew {

/// How often neighbor lists were made, and how long they are.
struct ListCounts {
  std::int64_t rebuilds = 0, surveys = 0, sorts = 0;  ///< counts of all pieces at once
  std::int64_t listed = 0, pruned = 0;                ///< pieces, one by one
  double outer = 0, inner = 0;                        ///< differences per block
  /// Wall time, s.
  double rebuilding = 0, pruning = 0, checking = 0, sorting = 0;
};

}  // namespace sinew

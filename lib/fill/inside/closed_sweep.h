// SPDX-License-Identifier: GPL-3.0-or-later
// Along a row of sites a closed surface's winding number is a whole number that changes at
// crossings only.
#pragma once

#include "fill/inside/row_crossings.h"
#include "fill/inside/row_runs.h"
#include "fill/lattice.h"
#include "mesh/surface.h"

namespace sinew {

class ClosedSweep {
 public:
  /// All must outlive this. `crossings` are those of the surface.
  ClosedSweep(const Lattice& lattice, const Surface& surface, const RowCrossings& crossings);

  /// Adds what the row has inside, in runs of the first component around them.
  void add_row(std::size_t row, SweptRows& found) const;

 private:
  const Lattice& lattice_;
  const Surface& surface_;
  const RowCrossings& crossings_;
  std::vector<int> owner_;  ///< of each component, where there are several
};

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// Along a row of sites an open surface's winding number jumps at crossings and changes smoothly
// between them, by what its caps add (fill/inside/open_winding.h).
#pragma once

#include "fill/inside/open_winding.h"
#include "fill/inside/row_crossings.h"
#include "fill/inside/row_runs.h"
#include "fill/lattice.h"
#include "mesh/surface.h"

namespace sinew {

class OpenSweep {
 public:
  /// All must outlive this. `crossings` are those of the surface without its caps.
  OpenSweep(const Lattice& lattice, const Surface& surface, const RowCrossings& crossings);

  /// Adds what the row has inside, in runs of body 0.
  void add_row(std::size_t row, SweptRows& found) const;

  /// At a site, within a few hundredths.
  double winding(std::size_t row, int site) const;

 private:
  void add_between(std::size_t row, int first, int last, int sum, RowRuns& runs) const;

  const Lattice& lattice_;
  const RowCrossings& crossings_;
  RowCrossings cap_crossings_;
  OpenWinding winding_;
};

}  // namespace sinew

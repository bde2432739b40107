// SPDX-License-Identifier: GPL-3.0-or-later
// The sites of a lattice inside a surface: those with a winding number above one half that are not
// on the surface itself, as runs of consecutive sites in a row.
#pragma once

#include <vector>

#include <sinew/fill/lattice.h>
#include <sinew/fill/row_crossings.h>
#include <sinew/fill/runs.h>
#include <sinew/mesh/surface.h>

namespace sinew {

struct InsideRuns {
  std::vector<Run> runs;            ///< runs by row, then site; never touching with the same body
  std::vector<RowSite> on_surface;  ///< sites on the surface: not inside
  int shallowest = 0;               ///< smallest winding number of closed surfaces; below 0 where
                                    ///< one is inside out
  int deepest = 0;                  ///< the largest winding number; above 1 where parts overlap
  /// Body of each component of closed surfaces, -1 for cavities. Components that share an inside
  /// site are one body. Empty for open surfaces, where all runs are of body 0.
  std::vector<int> body_of;
  int bodies = 0;
  std::vector<int> block_of;  ///< per body: the first of those that it shares walls with
};

/// The same for any number of threads.
InsideRuns inside_runs(const Lattice& lattice, const Surface& surface);

/// Returns the fraction of about 4,000 sites all over the lattice whose winding number differs by
/// more than 0.1 from any integer: 0 for closed surfaces, near 1 where nothing is inside.
double ambiguous_fraction(const Lattice& lattice, const Surface& surface);

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// The sites of a lattice near a surface: to keep particles clear of it, or to fill a layer on it.
// Triangles dilated by the distance are rasterised onto the rows; no site is asked for its nearest
// triangle. The cost grows with the rows that each dilated triangle meets.
#pragma once

#include <vector>

#include "core/triangles.h"
#include "fill/lattice.h"
#include "fill/runs.h"

namespace sinew {

/// All sites whose distance from the surface is at most `distance` (>= 0, m; from a small part of
/// the spacing to many spacings), as runs of body 0 by row, then site, none touching. Any triangles
/// will do, those without area too. Right but for rounding: 1e-15 of the coordinates. The same for
/// every number of threads.
std::vector<Run> runs_near(const Lattice& lattice, const Triangles& surface, double distance);

}  // namespace sinew

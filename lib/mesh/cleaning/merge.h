// SPDX-License-Identifier: GPL-3.0-or-later
// The first half of cleaning: triangles over points that differ, none collapsed, none doubled.
#pragma once

#include "core/polygon_soup.h"
#include "mesh/surface.h"

namespace sinew {

/// Cuts, merges (points closer than `weld`, m) and drops as clean() says, counting into `counts`.
Triangles merged_triangles(const PolygonSoup& soup, double weld, CleaningCounts& counts);

}  // namespace sinew

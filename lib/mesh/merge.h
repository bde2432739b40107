// SPDX-License-Identifier: GPL-3.0-or-later
// The first half of cleaning: triangles over points that differ, none collapsed, none doubled.
#pragma once

#include "mesh/surface.h"
#include "core/polygon_soup.h"

namespace sinew {

/// Cuts, merges and drops as clean() says, counting into `counts`.
Triangles merged_triangles(PolygonSoup soup, CleaningCounts& counts);

}  // namespace sinew

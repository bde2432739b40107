// SPDX-License-Identifier: GPL-3.0-or-later
// What must hold of a soup before anything is done with it.
#pragma once

#include "core/polygon_soup.h"

namespace sinew {

/// Throws Error (bad input) unless it has faces, each of three corners or more that are points of
/// it, and coordinates that are finite.
void check_soup(const PolygonSoup& soup);

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// How much there is to fill, before it is filled.
#pragma once

#include "mesh/surface.h"

namespace sinew {

/// The radius (m) at which a volume (m^3) holds about `count` particles: (V / (4 sqrt(2) N))^(1/3).
double radius_for_count(double volume, double count);

/// About the volume inside a surface, m^3: exact where that is what closed, separate parts enclose,
/// else from a coarse filling.
double volume_inside(const Surface& surface);

/// The share of places in a surface's box whose winding number is farther than 0.1 from any whole
/// number: 0 for closed surfaces, near 1 where there is no inside.
double ambiguous_share(const Surface& surface);

}  // namespace sinew

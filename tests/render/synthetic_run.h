// SPDX-License-Identifier: GPL-3.0-or-later
// A run without a simulation: the paper's box, bent or twisted smoothly about its middle.
#pragma once

#include <sinew/core/vector.h>
#include <sinew/render/snapshot.h>

namespace sinew {

/// 2,965 particles of 0.01 m colored by displacement, an 8 x 10 x 25 cell surface and two bones;
/// the far half bent by `bend` towards +x and turned by `twist` about the bone, rad.
Snapshot synthetic_snapshot(double bend, double twist);

/// Displacement, 0 .. 0.5 m.
ColorScale synthetic_scale();

}  // namespace sinew

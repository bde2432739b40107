// SPDX-License-Identifier: GPL-3.0-or-later
// A lattice inside, and around it a layer that follows the surface, half the distance of two
// layers below it; particles between the two push each other into place.
#pragma once

#include <sinew/fill/detail/irregular.h>

namespace sinew {

/// The places and bodies of the particles alone. Throws bad input where a surface is open, its
/// parts overlap, or a layer along it is filled.
Irregular conformal_packing(const BodySpace& space, const PackOptions& options,
                            const FilledSites& filled);

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// A packing without order: particles are strewn over the body and what surrounds it as densely as
// in a lattice, push each other apart, and those inside are kept. So it is the same everywhere, at
// surfaces too.
#pragma once

#include <sinew/fill/detail/irregular.h>

namespace sinew {

/// The places and bodies of the particles alone.
Irregular random_packing(const BodySpace& space, const PackOptions& options,
                         const FilledSites& filled);

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// Which patches bound cavities.
#pragma once

#include "core/settings.h"
#include "mesh/cleaning/patch_shapes.h"

namespace sinew {

/// Per patch. Those whose volume decides count as shells, closed by their caps. One within another
/// is a cavity of it where the two turn against each other in the file, with the rule `hollow` in
/// any case; within a cavity that makes it a body again.
std::vector<bool> cavities_of(const Triangles& surface, const Patches& patches,
                              const PatchShapes& shapes, FillRule rule);

}  // namespace sinew

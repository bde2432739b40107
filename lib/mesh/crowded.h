// SPDX-License-Identifier: GPL-3.0-or-later
// Patches that meet at edges of three and more faces.
#pragma once

#include "mesh/patch_shapes.h"

namespace sinew {

/// Flips `turn` of patches, the smallest volumes first, as long as that makes what is open of the
/// crowded edges shorter. So a hollow of a body, cut off by a face left over within, which encloses
/// as much inside out as it does not, turns as the body does.
void shorten_border(const Triangles& surface, std::span<const EdgeUse> uses, const Patches& patches,
                    const PatchShapes& shapes, std::vector<bool>& turn);

}  // namespace sinew

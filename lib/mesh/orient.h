// SPDX-License-Identifier: GPL-3.0-or-later
// Which side of each patch is outside.
#pragma once

#include "core/settings.h"
#include "mesh/patches.h"

namespace sinew {

/// The faces to reverse for bodies to point outward and cavities into themselves, as clean() says.
/// In this order: the sign of what each patch encloses with its caps; for those within others, the
/// rule; patches whose volume says nothing turn or stay as most of the area of the others does;
/// last, patches that meet at crowded edges turn where that leaves less border.
std::vector<bool> faces_to_turn(const Triangles& surface, std::span<const EdgeUse> uses,
                                const Patches& patches, FillRule rule);

}  // namespace sinew

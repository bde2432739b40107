// SPDX-License-Identifier: GPL-3.0-or-later
// Which side of each patch is outside.
#pragma once

#include "core/settings.h"
#include "mesh/cleaning/patches.h"

namespace sinew {

/// The faces to reverse for bodies to point outward and cavities into themselves, as clean() says.
/// Patches whose volume says nothing turn or stay as most of the area of the others of their
/// component does, without such as most of all others, without any by the sign of the volume of all
/// faces about the middle of their box.
std::vector<bool> faces_to_turn(const Triangles& surface, std::span<const EdgeUse> uses,
                                const Patches& patches, const Components& components,
                                FillRule rule);

}  // namespace sinew

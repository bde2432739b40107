// SPDX-License-Identifier: GPL-3.0-or-later
// The choice of a motion by its name.
#pragma once

#include <string_view>
#include <vector>

#include "rig/clip.h"

namespace sinew {

/// Throws bad input (without the path) for a name that is not there, with the nearest one that is.
const Clip& find_clip(const std::vector<Clip>& clips, std::string_view name);

}  // namespace sinew

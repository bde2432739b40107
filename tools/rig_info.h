// SPDX-License-Identifier: GPL-3.0-or-later
// What is in a rig and its clips.
#pragma once

#include <filesystem>
#include <optional>

#include "results.h"
#include "rig/clip.h"

namespace sinew {

/// Bones, frames, clips, the tree of names; and, for particles of `radius` (m), how fast the bones
/// would move them.
void add_rig_info(const Rig& rig, std::optional<double> radius, Results& results);

}  // namespace sinew

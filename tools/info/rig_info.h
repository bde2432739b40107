// SPDX-License-Identifier: GPL-3.0-or-later
// What is in a rig and its clips.
#pragma once

#include <optional>
#include <string>

#include "command/results.h"
#include <sinew/rig/motion.h>
#include <sinew/settings/settings.h>

namespace sinew {

/// Bones, frames, clips, the tree of names; and, for particles of `radius` (m), how fast the bones
/// would move them.
void add_rig_info(const Rig& rig, std::optional<double> radius, Results& results);

/// A motion as a clip; its frames are of the rate in which its keys are given, if any (1/s).
Clip clip_of(Motion motion, std::string name, std::optional<double> frame_rate);

/// The same of a YAML file that holds bones or tracks alone (config/rig.h); a clip alone has no
/// tree, but the bones it moves. Throws bad input.
void add_rig_alone_info(const Settings& settings, const std::string& name,
                        std::optional<double> radius, Results& results);

}  // namespace sinew

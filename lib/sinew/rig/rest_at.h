// SPDX-License-Identifier: GPL-3.0-or-later
// Another rest pose for a rig: files of motion capture rest with all bones along one axis, or with
// none of any length, and their clips make a figure of them.
//
//     rig = with_rest_at(std::move(rig), rig.clips[0].motion, 1.5);
#pragma once

#include <sinew/rig/motion.h>

namespace sinew {

/// The rig whose rest pose is that of `clip` at `time` (s of the clip). All its clips move joints
/// and ends to the same places as before; bones point anew to the children's places, but those that
/// their children leave by over a twentieth of the skeleton's size, such as a root on the ground,
/// are stubs. Throws bad input for clips that twist or stretch bones.
Rig with_rest_at(const Rig& rig, const Motion& clip, double time);

}  // namespace sinew

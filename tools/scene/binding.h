// SPDX-License-Identifier: GPL-3.0-or-later
// How a scene binds its particles to its bones.
#pragma once

#include "core/settings.h"
#include "rig/binding.h"

namespace sinew {

/// Binds particles of `radius` (m) at `rest` as section binding says. Throws bad input, naming the
/// scene's line: for weights of a file without any, a bone without a name of the skeleton, numbers
/// of particles that are not there, and half a box or ball.
Binding bind_scene(const Settings& settings, const Skeleton& skeleton, const Points& rest,
                   double radius);

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// The testing machine of a scene: its supports and loads, made for its particles.
//
//     add_machine(settings, body, {files.surface, components}, world);
#pragma once

#include <span>

#include <sinew/physics/world/world.h>
#include <sinew/scene/parts.h>

namespace sinew {

/// Adds the lists `supports` and `loads` to a world that has its pins. Throws bad input, with the
/// scene's line, for parts without particles or faces, and for supports that contradict each other.
void add_machine(const Settings& settings, const Body& body, const Parts& parts, World& world);

}  // namespace sinew

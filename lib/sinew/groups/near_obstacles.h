// SPDX-License-Identifier: GPL-3.0-or-later
// Particles that obstacles press, and what yields with them: a group there would be too stiff.
//
//     sizes.kept_free = near_obstacles(body, motion, duration);
//
// Under an indenter a body is deformed about as deep as the contact is wide, and where that is wide
// about as deep as the body. So all is free up to two widths of the contact from the obstacle, from
// a quarter of the body's width to all of it. Groups that begin there change the force by less than
// 5 % (README.md).
#pragma once

#include <cstdint>
#include <vector>

#include <sinew/rig/motion.h>

namespace sinew {

struct Body;

/// Marks by particle id: 1 where an obstacle comes that near until `end` (s), while the bones carry
/// the particles rigidly. Some more than these may be marked. Empty without obstacles. In parallel.
std::vector<std::uint8_t> near_obstacles(const Body& body, const Motion& motion, double end);

}  // namespace sinew

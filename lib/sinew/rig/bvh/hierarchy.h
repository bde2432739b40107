// SPDX-License-Identifier: GPL-3.0-or-later
// The first part of a BVH file: the joints, their offsets and their channels.
#pragma once

#include <vector>

#include <sinew/rig/bvh/bvh.h>
#include <sinew/rig/bvh/text.h>

namespace sinew {

/// Takes the HIERARCHY off the text, all roots of it. Throws bad input.
std::vector<BvhJoint> read_hierarchy(BvhText& text);

}  // namespace sinew

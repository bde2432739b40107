// SPDX-License-Identifier: GPL-3.0-or-later
// What in a motion would tear a body, or is not done as asked.
#pragma once

#include <string>
#include <vector>

#include "rig/motion.h"

namespace sinew {

/// One line each, with numbers and a cure: bones that do not begin at rest without a preroll, that
/// jump from key to key or where a loop closes, and that are held at their limits. Shifts below
/// `least_shift` (m) and turns below a degree are not worth a word.
std::vector<std::string> motion_warnings(const Skeleton& skeleton, const Motion& motion,
                                         double least_shift);

}  // namespace sinew

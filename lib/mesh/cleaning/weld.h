// SPDX-License-Identifier: GPL-3.0-or-later
// Points that are one.
#pragma once

#include <vector>

#include "core/vector.h"

namespace sinew {

/// For each point the one it becomes: itself, or an earlier one. Points are taken in their order:
/// each becomes the earliest kept one that equals it or is closer than `distance` (m; 0 or less:
/// equal ones only), or is kept. So the kept ones are all at least that far apart, and no point
/// moves farther than that, however long a chain of close points is.
std::vector<int> first_within(const Points& points, double distance);

}  // namespace sinew

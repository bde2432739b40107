// SPDX-License-Identifier: GPL-3.0-or-later
// Which components of a closed surface make one body.
#pragma once

#include <vector>

#include "fill/inside/inside_runs.h"
#include "fill/inside/row_runs.h"

namespace sinew {

/// Joins overlapping components and numbers what encloses a volume, or holds sites, by its first
/// component.
void number_bodies(const std::vector<SweptRows>& found, const Surface& surface, InsideRuns& inside);

}  // namespace sinew

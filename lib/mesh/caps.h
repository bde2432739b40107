// SPDX-License-Identifier: GPL-3.0-or-later
// What closes holes.
#pragma once

#include <span>

#include "core/triangles.h"
#include "mesh/loops.h"

namespace sinew {

/// Faces over copies of the loop's points that go along its edges in the other direction. Each halves
/// what is left of the loop: most of them are small and near the border. Appends to `caps`.
void add_cap(const Loop& loop, const Points& points, Triangles& caps);

/// All of them, in the order of the loops.
Triangles caps_of(std::span<const Loop> loops, const Points& points);

}  // namespace sinew

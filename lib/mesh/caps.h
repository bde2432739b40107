// SPDX-License-Identifier: GPL-3.0-or-later
// What closes holes.
#pragma once

#include <span>

#include "core/triangles.h"
#include "mesh/loops.h"

namespace sinew {

/// Faces that go along the loop's edges in the other direction: a fan from the mean of its points,
/// over copies of them; for three points one face. Appends to `caps`.
void add_cap(const Loop& loop, const Points& points, Triangles& caps);

/// All of them, in the order of the loops.
Triangles caps_of(std::span<const Loop> loops, const Points& points);

}  // namespace sinew

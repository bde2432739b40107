// SPDX-License-Identifier: GPL-3.0-or-later
// Where a surface ends, whatever its patches.
#pragma once

#include <span>

#include "mesh/edges.h"
#include "mesh/loops.h"
#include "mesh/surface.h"

namespace sinew {

/// Forward minus backward uses of one edge.
int net_count(std::span<const EdgeUse> use);

/// The holes' edges, in the direction of the faces at them: loops of group 0. The cap of loop i is
/// the i-th one in Surface::caps.
std::vector<Loop> border_loops(std::span<const EdgeUse> uses);

/// Counts and lengths of the border with these loops.
Border border_of(const Triangles& surface, std::span<const EdgeUse> uses,
                 std::span<const Loop> loops);

}  // namespace sinew

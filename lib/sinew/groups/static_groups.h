// SPDX-License-Identifier: GPL-3.0-or-later
// Groups for a whole run: far from joints that bend, what follows one bone, or bones that are stiff
// to each other, moves as one. Large groups may move by cubics, which bend: they begin nearer to
// joints.
//
//     body.grouping = std::make_shared<const Grouping>(static_groups(body, bends, {}));
#pragma once

#include <vector>

#include <sinew/body/grouping.h>
#include <sinew/core/cell_grid.h>
#include <sinew/groups/bone_assemblies.h>
#include <sinew/groups/make_grouping.h>

namespace sinew {

/// For each bone, whether it turns, shifts or stretches relative to its parent until `end` (s).
std::vector<bool> moving_joints(const Skeleton& skeleton, const Motion& motion, double end);

/// `moves`: of each bone, its joint with its parent. Particles that pins, supports, loads or
/// muscles act on, or that no bone holds, are free.
Grouping static_groups(const Body& body, const std::vector<bool>& moves, const GroupSizes& sizes);

/// Numbers what hangs together in each group anew; what has fewer particles than `least` becomes
/// free. `near`: nearest neighbors, by id.
void separate(const NeighborLists& near, std::size_t least, std::vector<std::int32_t>& group);

}  // namespace sinew

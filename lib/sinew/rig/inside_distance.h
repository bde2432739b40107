// SPDX-License-Identifier: GPL-3.0-or-later
// How far particles are from bones by the path inside the body: along chains of particles that
// touch at rest (or touch one and the same), so that no path leads across a gap. In the open such
// paths are up to 6 % longer than straight ones; so much of a detour counts as none.
#pragma once

#include <vector>

#include <sinew/core/cell_grid.h>
#include <sinew/rig/skeleton.h>

namespace sinew {

struct BoneDistance {
  int bone = no_bone;
  double distance = 0;  ///< m
};

/// A body as paths lead through it.
struct InsidePaths {
  NeighborLists links;  ///< of particles that touch, or touch one and the same
  Points points;        ///< m
  /// Where the paths from each bone begin: particles that have it as their nearest and lie within
  /// 1.5 radii of it, or not more than half a radius farther than the nearest of them.
  std::vector<std::vector<std::uint32_t>> starts;
  std::vector<int> straight_nearest;  ///< bone of each particle through the air
};

InsidePaths inside_paths(const Points& rest, const Skeleton& skeleton, double radius);

/// Per particle, by bone: the nearest bone by the paths inside and all others not more than `reach`
/// (m) farther. Empty where no path leads.
std::vector<std::vector<BoneDistance>> near_inside(const InsidePaths& paths,
                                                   const Skeleton& skeleton, double reach);

/// The nearest of one particle's; the lower bone on ties, no_bone of none.
BoneDistance nearest_of(const std::vector<BoneDistance>& near);

}  // namespace sinew

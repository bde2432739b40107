// SPDX-License-Identifier: GPL-3.0-or-later
// How far particles are from bones by the way inside the body: along chains of particles that touch
// at rest, so that no way leads across a gap. Such ways are up to 15 % longer than straight ones.
#pragma once

#include <vector>

#include "core/neighbours.h"
#include "rig/skeleton.h"

namespace sinew {

struct BoneDistance {
  int bone = no_bone;
  double distance = 0;  ///< m
};

/// A body as ways lead through it.
struct InsideWays {
  NeighbourLists links;  ///< of touching particles
  Points points;         ///< m
  /// Where the ways from each bone begin: particles that have it as their nearest and lie within
  /// 1.5 radii of it, or not more than half a radius farther than the nearest of them.
  std::vector<std::vector<std::uint32_t>> starts;
  std::vector<int> straight_nearest;  ///< bone of each particle through the air
};

InsideWays inside_ways(const Points& rest, const Skeleton& skeleton, double radius);

/// Per particle the nearest bone by the ways inside (the lower one on ties); no_bone where none
/// leads.
std::vector<BoneDistance> nearest_inside(const InsideWays& ways, const Skeleton& skeleton);

/// Per particle all bones whose way is at most `reach` (m) longer than the nearest's, by bone.
std::vector<std::vector<BoneDistance>> near_inside(const InsideWays& ways, const Skeleton& skeleton,
                                                   const std::vector<BoneDistance>& nearest,
                                                   double reach);

}  // namespace sinew

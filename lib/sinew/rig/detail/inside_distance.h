// SPDX-License-Identifier: GPL-3.0-or-later
// Distances of particles from bones by paths inside the body: along chains of particles that touch
// at rest (or touch a common one), so that no path crosses a gap. Such paths are up to 6 % longer
// than straight lines; up to that a path counts as straight.
//
//     const auto near = near_inside(inside_paths(rest, skeleton, radius), skeleton, reach);
//     const int bone = nearest_of(near[i]).bone;
#pragma once

#include <vector>

#include <sinew/core/cell_grid.h>
#include <sinew/rig/skeleton.h>

namespace sinew {

struct BoneDistance {
  int bone = no_bone;
  double distance = 0;  ///< m
};

/// The graph of a body's particles.
struct InsidePaths {
  NeighborLists links;  ///< between particles that touch, or touch a common one
  Points points;        ///< m
  /// Where the paths from each bone begin: particles for which it is the nearest bone and that lie
  /// within 1.5 radii of it, or at most half a radius farther away than the nearest of them.
  std::vector<std::vector<std::uint32_t>> starts;
  std::vector<int> straight_nearest;  ///< nearest bone of each particle by straight distance
};

InsidePaths inside_paths(const Points& rest, const Skeleton& skeleton, double radius);
/// The same with the nearest neighbors at rest.
InsidePaths inside_paths(const Points& rest, const Skeleton& skeleton, double radius,
                         const NeighborLists& nearest);

/// Per particle, ascending by bone: the nearest bone by the paths inside, and all others at most
/// `reach` (m) farther. Empty for particles without a path.
std::vector<std::vector<BoneDistance>> near_inside(const InsidePaths& paths,
                                                   const Skeleton& skeleton, double reach);

/// The nearest bone of one particle; the lower one on ties, no_bone without any.
BoneDistance nearest_of(const std::vector<BoneDistance>& near);

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// Groups for a whole run: far from joints that bend, what follows one bone, or bones that are stiff
// to each other, moves as one. Large groups may move by cubics, which bend: they begin nearer to
// joints.
//
//     body.grouping = std::make_shared<const Grouping>(static_groups(body, bends, {}));
#pragma once

#include <optional>
#include <vector>

#include <sinew/physics/hierarchy/bone_parts.h>
#include <sinew/physics/hierarchy/grouping.h>

namespace sinew {

struct StaticGroups {
  /// Particles nearer than this to a joint are free: along the bone, in square roots of the
  /// cross-section of the bone whose head the joint is.
  double joint_distance = 1;
  std::size_t least = 4096;  ///< particles of a group
  /// The same for cubic groups; none: there are none.
  std::optional<double> cubic_distance = {};
  std::size_t least_cubic = 16384;  ///< particles of a cubic group
};

/// For each bone, whether it turns, shifts or stretches relative to its parent until `end` (s).
std::vector<bool> moving_joints(const Skeleton& skeleton, const Motion& motion, double end);

/// `moves`: of each bone, its joint with its parent. Particles that pins, supports, loads or
/// muscles act on, or that no bone holds, are free.
Grouping static_groups(const Body& body, const std::vector<bool>& moves,
                       const StaticGroups& options);

/// Numbers what hangs together in each group anew; what has fewer particles than `least` becomes
/// free.
void separate(const Body& body, std::size_t least, std::vector<std::int32_t>& group);

}  // namespace sinew

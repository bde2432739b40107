// SPDX-License-Identifier: GPL-3.0-or-later
// Where bones meet, and how weights change from a parent to its children there.
//
//     const JointZones zones = joint_zones(skeleton, section, 1.0);
//     const std::vector<BoneWeight> weights = weights_in_zones(zones, lead, point, distance);
//
// A joint lies at the child's head. Near the parent's tail the child's weight rises linearly along
// the joint's axis (the mean direction of both bones); elsewhere on the parent it depends on how
// much nearer the child is. Children in one joint zone divide it by their distances, over a width
// that vanishes at the zone's end: beyond it each has its own particles. All weights are continuous
// in the body, except where bones that are neither parent and child nor in one joint zone are side
// by side. A zone is never longer than a bone with joints at both ends.
#pragma once

#include <functional>
#include <vector>

#include <sinew/rig/skeleton.h>
#include <sinew/rig/skinning.h>

namespace sinew {

/// Between a bone and its parent; none if its length is 0.
struct JointZone {
  double length = 0;          ///< m
  bool across_axis = false;   ///< weights rise along `axis`, not with the difference of distances
  Vec3 place = Vec3::Zero();  ///< the child's head, m
  Vec3 axis = Vec3::Zero();   ///< unit, points into the child
};

struct JointZones {
  std::vector<int> parent;                 ///< parent of each bone
  std::vector<JointZone> above;            ///< zone between each bone and its parent
  std::vector<std::vector<int>> children;  ///< children of each bone that have a zone
  std::vector<double> before, beyond;      ///< how far feet may be beyond head and tail, m

  double longest() const;
};

/// `section`: cross-section of each bone, m^2; `joint_zone` in their square roots.
JointZones joint_zones(const Skeleton& skeleton, const std::vector<double>& section,
                       double joint_zone);

/// The bones that hold a point whose nearest bone is `lead`, with weights of sum 1, the heaviest
/// first. `distance(bone)`: from the point, m; infinite where the bone is out of reach.
std::vector<BoneWeight> weights_in_zones(const JointZones& zones, int lead, const Vec3& point,
                                         const std::function<double(int)>& distance);

}  // namespace sinew

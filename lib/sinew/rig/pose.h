// SPDX-License-Identifier: GPL-3.0-or-later
// Where every bone is at one moment, and how it moves.
//
//     const Vec3 now = pose[b].carried(point, skeleton.bones[b]);
//     const Vec3 velocity = pose[b].velocity_at(now);
#pragma once

#include <vector>

#include <sinew/rig/skeleton.h>

namespace sinew {

struct BonePose {
  RigidFrame frame;                      ///< head and axes now; at rest it is Bone::rest
  Mat3 turn = Mat3::Identity();          ///< rotation since rest, frame.rotation rest.rotation^T
  Vec3 velocity = Vec3::Zero();          ///< velocity of the head, m/s
  Vec3 angular_velocity = Vec3::Zero();  ///< rad/s
  double twist = 0;         ///< rotation about the bone itself as the motion gives it, rad
  double stretch = 1;       ///< factor of the length: s along the axis becomes stretch s
  double stretch_rate = 0;  ///< 1/s

  Vec3 axis() const { return frame.rotation.col(0); }
  /// Present position of a point of the bone that was at `point` when the bone was `bone` at rest.
  Vec3 carried(const Vec3& point, const Bone& bone) const {
    const Vec3 offset = point - bone.head();
    const double longer = (stretch - 1) * bone.axis().dot(offset);
    return frame.origin + turn * (offset + longer * bone.axis());
  }
  /// Velocity of the point of this bone that is at `p`, m/s; rigid: without its stretching.
  Vec3 rigid_velocity_at(const Vec3& p) const {
    return velocity + angular_velocity.cross(p - frame.origin);
  }
  Vec3 velocity_at(const Vec3& p) const {
    if (stretch_rate == 0) return rigid_velocity_at(p);
    return rigid_velocity_at(p) + stretch_rate / stretch * axis().dot(p - frame.origin) * axis();
  }
};

using Pose = std::vector<BonePose>;  ///< one per bone, in the skeleton's order

/// The pose at rest, without motion.
Pose rest_pose(const Skeleton& skeleton);

}  // namespace sinew

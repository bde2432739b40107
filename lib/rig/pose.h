// SPDX-License-Identifier: GPL-3.0-or-later
// Where every bone is at one moment, and how it moves.
#pragma once

#include <vector>

#include "rig/skeleton.h"

namespace sinew {

struct BonePose {
  RigidFrame frame;                      ///< head and axes now; at rest it is Bone::rest
  Mat3 turn = Mat3::Identity();          ///< rotation since rest, frame.rotation rest.rotation^T
  Vec3 velocity = Vec3::Zero();          ///< of the head, m/s
  Vec3 angular_velocity = Vec3::Zero();  ///< rad/s
  double twist = 0;                      ///< turn about the bone itself asked by the motion, rad

  Vec3 axis() const { return frame.rotation.col(0); }
  /// Velocity of the point of this rigid bone that is at `p` now, m/s.
  Vec3 velocity_at(const Vec3& p) const {
    return velocity + angular_velocity.cross(p - frame.origin);
  }
};

using Pose = std::vector<BonePose>;  ///< one per bone, in the skeleton's order

/// The pose at rest, without motion.
Pose rest_pose(const Skeleton& skeleton);

}  // namespace sinew

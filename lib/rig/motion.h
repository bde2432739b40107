// SPDX-License-Identifier: GPL-3.0-or-later
// Keys over time for the bones of a skeleton, and the pose they give at any moment.
//
// A bone's rotation turns it, and all that hangs on it, about its head; it is given in the
// directions of its parent (of the scene for a root), which at rest are the scene's. Twist turns
// the bone about its own axis before that rotation and is kept apart, so that it may pass 180
// degrees.
#pragma once

#include <vector>

#include "core/settings.h"
#include "rig/pose.h"
#include "rig/skeleton.h"

namespace sinew {

/// What a track says of one bone at one moment, relative to the parent, with its rate of change.
struct LocalMotion {
  Quat rotation = Quat::Identity();
  Vec3 angular_velocity = Vec3::Zero();  ///< of rotation, in the parent's directions, rad/s
  double twist = 0, twist_rate = 0;      ///< rad, rad/s
  Vec3 translation = Vec3::Zero();       ///< m, in the parent's directions
  Vec3 velocity = Vec3::Zero();          ///< of translation, m/s
};

struct Key {
  double time = 0;  ///< s
  Quat rotation = Quat::Identity();
  Vec3 turn = Vec3::Zero();         ///< rotation vector that leads here from the key before, rad
  double twist = 0;                 ///< rad
  Vec3 translation = Vec3::Zero();  ///< m
};

/// Keys of one bone in ascending time; before the first and after the last the motion holds.
struct Track {
  int bone = no_bone;
  Interpolation interpolation = Interpolation::smooth;
  std::vector<Key> keys;

  LocalMotion at(double time) const;
};

struct Motion {
  std::vector<Track> tracks;  ///< at most one per bone
};

/// Builds the motion a scene describes. Throws bad input, naming the scene's line, for an unknown
/// bone, two tracks of one bone, keys out of order, or a rotation given in two ways or by half.
Motion make_motion(const Settings& settings, const Skeleton& skeleton);

/// The pose at `time` (s), with the velocities of the moving bones.
Pose pose_at(const Skeleton& skeleton, const Motion& motion, double time);

}  // namespace sinew

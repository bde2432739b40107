// SPDX-License-Identifier: GPL-3.0-or-later
// Poses of one motion at many times, as a run asks for them: step by step. What stays the same from
// one to the next is found once: the piece of each curve between two keys, and how bones hang on
// each other. Any order of times gives the same bits.
#pragma once

#include <vector>

#include "rig/motion.h"

namespace sinew {

class PoseCursor {
 public:
  /// Both must stay, as they are.
  PoseCursor(const Skeleton& skeleton, const Motion& motion);

  /// The pose at `time`, s of the scene; there until the next call.
  const Pose& at(double time);

 private:
  /// A bone on its parent; the scene holds roots.
  struct Link {
    int parent = no_bone, track = -1;  ///< -1: nothing moves it
    bool limited = false;
    Vec3 offset = Vec3::Zero();    ///< of its head from the parent's, at rest
    Vec3 along = Vec3::Zero();     ///< the part of it along the parent, which stretches
    Vec3 axis = Vec3::Zero();      ///< its own, at rest
    Mat3 rest = Mat3::Identity();  ///< its axes at rest
  };

  static void carry(const Link& link, const BonePose& parent, BonePose& pose);
  static void move(const Link& link, const LocalMotion& local, const BonePose& parent,
                   BonePose& pose);

  const Skeleton* skeleton_;
  const Motion* motion_;
  std::vector<Link> links_;           ///< of each bone
  std::vector<TrackCursor> cursors_;  ///< of each track
  Pose pose_;
};

}  // namespace sinew

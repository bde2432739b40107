// SPDX-License-Identifier: GPL-3.0-or-later
// Bones moved by hand: what a person drags sets targets, which the bones approach smoothly and no
// faster than a bound, a key at a time.
//
//     Hand hand(skeleton);
//     hand.aim(bone, place, keys);            // the bone's tip to a place
//     keys = hand.next(keys, 1.0 / 60);       // the key after this one
#pragma once

#include <optional>
#include <vector>

#include <sinew/core/vector.h>
#include <sinew/rig/motion.h>
#include <sinew/rig/skeleton.h>

namespace sinew {

/// The motion of each bone at one key.
using BoneKeys = std::vector<LocalMotion>;

/// The pose of these keys, within the limits of joints.
Pose pose_of(const Skeleton& skeleton, const BoneKeys& keys);

/// What hands may do to a bone.
struct HandSpeed {
  double turn = pi;    ///< rad/s
  double shift = 1;    ///< m/s
  double ramp = 0.25;  ///< s until it is reached
};

class Hand {
 public:
  Hand(Skeleton skeleton, HandSpeed speed);

  // Each takes the keys from which the bones move on. Throws bad input for a bone that is not there
  // and places that are not finite.

  /// Turns a bone about its head until its tip looks to a place (m).
  void aim(int bone, const Vec3& to, const BoneKeys& now);
  /// Turns a bone and those above it until its tip is at a place (m), or as near as they get.
  void reach(int bone, const Vec3& to, const BoneKeys& now);
  /// Moves the head of a bone without parent to a place (m).
  void move(int bone, const Vec3& to, const BoneKeys& now);
  /// Turns a bone by an angle (rad, of any size) about an axis of the scene through its head.
  void turn(int bone, const Vec3& axis, double angle, const BoneKeys& now);

  /// Begins a drag: undo() goes back to where the bones were to go before it.
  void grab();
  /// Takes back the last drag; false where there is none.
  bool undo();

  /// Whether a bone has been touched: it has left its clip.
  bool has(int bone) const;
  /// Whether a touched bone has come to where it is to go.
  bool is_there(int bone, const BoneKeys& now) const;
  /// Takes all bones as they are.
  void hold(const BoneKeys& now);

  /// The keys after `now`, `interval` (s) later, of touched bones; others are as in `now`.
  BoneKeys next(BoneKeys now, double interval);

 private:
  /// A bone's way; none: untouched.
  struct Way {
    Quat rotation = Quat::Identity();
    Vec3 translation = Vec3::Zero();
    Vec3 spin = Vec3::Zero();  ///< rotation that is left, in the parent's directions, rad
    bool spins = false;        ///< whether it is `spin` that leads, not the shortest way
    Vec3 turning = Vec3::Zero(), shifting = Vec3::Zero();  ///< speeds, rad/s and m/s
  };
  using Ways = std::vector<std::optional<Way>>;

  Way& touch(int bone, const BoneKeys& now);
  void set_rotation(int bone, const Quat& rotation, const BoneKeys& now);
  std::vector<int> turning_above(const BoneKeys& now) const;
  void approach(Way& way, LocalMotion& key, double interval, double share) const;

  Skeleton skeleton_;
  HandSpeed speed_;
  Ways ways_;
  std::vector<Ways> before_;  ///< before each drag
};

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// Bones moved by hand: they turn smoothly from how they are to new rotations, and stay there.
//
//     Posing posing(prepared.body.skeleton, prepared.motion);
//     posing.turn({{"upper", rotation}}, simulation.time(), 0.5);
//     simulation.play(posing.motion());
#pragma once

#include <map>
#include <string>

#include <sinew/core/vector.h>
#include <sinew/rig/motion.h>
#include <sinew/rig/skeleton.h>

namespace sinew {

/// Rotations of bones by name, relative to rest, in the parent's directions (roots: the scene's).
using BoneRotations = std::map<std::string, Quat>;

class Posing {
 public:
  /// `motion`: of the bones so far.
  Posing(Skeleton skeleton, Motion motion);

  /// Turns bones to these rotations from `time` on, within `over` (both s). Whatever is not named,
  /// now or before, stops where it is; twists, shifts and stretches stay as they are. Throws bad
  /// input for a bone that is not there, a rotation that is none, and a time that is not positive;
  /// nothing has changed then.
  void turn(const BoneRotations& rotations, double time, double over);

  /// For Simulation::play().
  const Motion& motion() const { return motion_; }

 private:
  Skeleton skeleton_;
  Motion motion_;
  BoneRotations targets_;
};

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// Bones moved by hand: they turn smoothly from how they are to new rotations, and stay there.
//
//     Posing posing(prepared.body.skeleton, prepared.motion);
//     posing.turn({{"upper", rotation}}, simulation.time(), 0.5);
//     simulation.play(posing.motion());
#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <sinew/core/vector.h>
#include <sinew/rig/motion.h>
#include <sinew/rig/skeleton.h>

namespace sinew {

/// Rotations of bones by name, relative to rest, in the parent's directions (roots: the scene's).
using BoneRotations = std::map<std::string, Quat>;

/// The last turn: all that a pose and those after it follow from.
struct PosedTurn {
  double time = 0, over = 0;      ///< s
  std::vector<LocalMotion> from;  ///< motion of each bone at that time
  BoneRotations targets;          ///< targets of earlier turns included
};

/// For core/archive.h; without velocities, which a turn does not take.
template <class Archive>
void serialize(Archive& archive, LocalMotion& motion) {
  archive(motion.rotation);
  archive(motion.translation);
  for (double* one : {&motion.twist, &motion.stretch}) archive(*one);
}

template <class Archive>
void serialize(Archive& archive, PosedTurn& turn) {
  std::vector<std::string> names;
  std::vector<Quat> rotations;
  for (const auto& [name, rotation] : turn.targets)
    names.push_back(name), rotations.push_back(rotation);
  for (double* one : {&turn.time, &turn.over}) archive(*one);
  archive(turn.from);
  archive(names);
  archive(rotations);
  turn.targets.clear();
  for (std::size_t i = 0; i < std::min(names.size(), rotations.size()); ++i)
    turn.targets[names[i]] = rotations[i];
}

class Posing {
 public:
  /// `motion`: of the bones so far.
  Posing(Skeleton skeleton, Motion motion);

  /// Turns bones to these rotations from `time` on, within `over` (both s). Whatever is not named,
  /// now or before, stops where it is; twists, shifts and stretches stay as they are. Throws bad
  /// input for a bone that is not there, a rotation that is none, and a time that is not positive;
  /// nothing has changed then.
  void turn(const BoneRotations& rotations, double time, double over);
  /// Turns as another of the same skeleton did. Throws bad input as turn() does, and for a turn of
  /// other bones.
  void repeat(const PosedTurn& turn);
  /// None before the first.
  const std::optional<PosedTurn>& last() const { return last_; }

  /// For Simulation::play().
  const Motion& motion() const { return motion_; }

 private:
  Skeleton skeleton_;
  Motion motion_;
  std::optional<PosedTurn> last_;
};

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/rig/posing.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <sinew/core/error.h>

namespace sinew {
namespace {

std::string names_of(const Skeleton& skeleton) {
  std::string names;
  for (const Bone& bone : skeleton.bones) names += (names.empty() ? "" : ", ") + bone.name;
  return names;
}

void check(const Skeleton& skeleton, const BoneRotations& rotations, double over) {
  if (!(over > 0 && std::isfinite(over)))
    throw bad_input("a pose takes no time", "give a time above 0, in seconds");
  for (const auto& [name, rotation] : rotations)
    if (std::none_of(skeleton.bones.begin(), skeleton.bones.end(),
                     [&name = name](const Bone& bone) { return bone.name == name; }))
      throw bad_input("there is no bone '" + name + "'", "take one of " + names_of(skeleton));
}

}  // namespace

Posing::Posing(Skeleton skeleton, Motion motion)
    : skeleton_(std::move(skeleton)), motion_(std::move(motion)) {}

void Posing::turn(const BoneRotations& rotations, double time, double over) {
  PosedTurn next{time, over, local_motions(skeleton_, motion_, time),
                 last_ ? last_->targets : BoneRotations()};
  for (const auto& [name, rotation] : rotations) next.targets[name] = rotation;
  repeat(next);
}

void Posing::repeat(const PosedTurn& turn) {
  check(skeleton_, turn.targets, turn.over);
  if (turn.from.size() != skeleton_.size() || !std::isfinite(turn.time))
    throw bad_input("the saved pose is of other bones",
                    "restore one that the same scene has saved");
  std::vector<TrackDefinition> tracks;
  for (std::size_t bone = 0; bone < turn.from.size(); ++bone) {
    const std::string& name = skeleton_.bones[bone].name;
    LocalMotion then = turn.from[bone];
    if (const auto target = turn.targets.find(name); target != turn.targets.end())
      then.rotation = target->second;
    tracks.push_back({name,
                      Interpolation::smooth,
                      "xyz",
                      {key_of(turn.from[bone], turn.time), key_of(then, turn.time + turn.over)}});
  }
  motion_ = played(make_motion(tracks, skeleton_), {});
  last_ = turn;
}

}  // namespace sinew

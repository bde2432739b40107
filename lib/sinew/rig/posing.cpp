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

KeyDefinition key_of(const LocalMotion& local, double time) {
  const Quat& q = local.rotation;
  KeyDefinition key;
  key.time = time;
  key.quaternion = {q.w(), q.x(), q.y(), q.z()};
  key.twist = degrees(local.twist);
  key.translation = local.translation;
  key.stretch = local.stretch;
  return key;
}

}  // namespace

Posing::Posing(Skeleton skeleton, Motion motion)
    : skeleton_(std::move(skeleton)), motion_(std::move(motion)) {}

void Posing::turn(const BoneRotations& rotations, double time, double over) {
  check(skeleton_, rotations, over);
  BoneRotations targets = targets_;
  for (const auto& [name, rotation] : rotations) targets[name] = rotation;
  const std::vector<LocalMotion> now = local_motions(skeleton_, motion_, time);
  std::vector<TrackDefinition> tracks;
  for (std::size_t bone = 0; bone < now.size(); ++bone) {
    const std::string& name = skeleton_.bones[bone].name;
    LocalMotion then = now[bone];
    if (const auto target = targets.find(name); target != targets.end())
      then.rotation = target->second;
    tracks.push_back(
        {name, Interpolation::smooth, "xyz", {key_of(now[bone], time), key_of(then, time + over)}});
  }
  motion_ = played(make_motion(tracks, skeleton_), {});
  targets_ = std::move(targets);
}

}  // namespace sinew

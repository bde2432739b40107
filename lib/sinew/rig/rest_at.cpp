// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/rig/rest_at.h>

#include <algorithm>

#include <sinew/core/error.h>
#include <sinew/rig/pose.h>
#include <sinew/rig/skeleton.h>

namespace sinew {
namespace {

constexpr double leaves = 0.05;  // fraction of the skeleton's size
constexpr double stub = 0.02;    // likewise

const Track* track_of(const Motion& motion, int bone) {
  for (const Track& track : motion.tracks)
    if (track.bone == bone) return &track;
  return nullptr;
}

/// Bones that a child leaves, as none does whose joint is on it.
std::vector<bool> left_by_children(const Skeleton& skeleton, const Motion& clip, double size) {
  std::vector<bool> left(skeleton.size());
  for (const Track& track : clip.tracks) {
    const int parent = skeleton.bones[track.bone].parent;
    if (parent == no_bone || track.translation.empty()) continue;
    Box places;
    for (const Vec3& shift : track.translation.values) places.extend(shift);
    if (places.diagonal().norm() > leaves * size) left[parent] = true;
  }
  return left;
}

/// The joints at a pose. Ends that are not at a child's place move with their bones.
std::vector<Joint> joints_at(const Skeleton& skeleton, const Pose& pose, const Motion& clip) {
  std::vector<Joint> resting, joints;
  std::vector<bool> holds(skeleton.size());
  for (const Bone& bone : skeleton.bones) {
    resting.push_back({bone.name, bone.parent, bone.head(), {}});
    if (bone.parent != no_bone) holds[bone.parent] = true;
  }
  const double size = bounds(skeleton).diagonal().norm();
  const Skeleton by_children = skeleton_of(resting);
  const std::vector<bool> left = left_by_children(skeleton, clip, size);
  for (std::size_t b = 0; b < skeleton.size(); ++b) {
    const Bone& bone = skeleton.bones[b];
    Joint joint{bone.name, bone.parent, pose[b].frame.origin, {}};
    const bool given = (by_children.bones[b].tail() - bone.tail()).norm() > 1e-6 * size;
    if (left[b])
      joint.end = joint.place + stub * size * pose[b].axis();
    else if (!holds[b] || given)
      joint.end = pose[b].carried(bone.tail(), bone);
    joints.push_back(std::move(joint));
  }
  return joints;
}

void turn(RotationCurve& curve, const Quat& parent, const Quat& reference) {
  const Quat after = reference.conjugate() * parent.conjugate();
  for (auto* quaternions : {&curve.values, &curve.in, &curve.out})
    for (Quat& q : *quaternions) q = parent * q * after;
  for (Vec3& step : curve.turns) step = parent * step;
}

void turn(Curve<Vec3>& curve, const Quat& parent, const Vec3& reference) {
  for (Vec3& value : curve.values) value = parent * (value - reference);
  for (auto* tangents : {&curve.in, &curve.out})
    for (Vec3& tangent : *tangents) tangent = parent * tangent;
}

/// A curve that stays where the file has the bone at rest.
template <class Curve, class Value>
void stay(Curve& curve, const Value& at_rest) {
  if (!curve.empty()) return;
  curve.times = {0};
  curve.values = {at_rest};
}

/// The motion of one bone from the new rest pose; `pose` has its parent `turned`.
void turn(Track& track, const Quat& turned, const LocalMotion& at_rest) {
  if (!track.twist.empty() || track.stretches())
    throw bad_input("a clip twists or stretches bones", "leave the rest pose as the file has it");
  if (!at_rest.rotation.isApprox(Quat::Identity())) stay(track.rotation, Quat::Identity());
  if (!at_rest.translation.isZero(0)) stay(track.translation, Vec3(Vec3::Zero()));
  turn(track.rotation, turned, at_rest.rotation);
  turn(track.translation, turned, at_rest.translation);
}

/// The same motion from the pose of `clip` at `time`; what that moves has a track.
Motion from_pose(Motion motion, const Skeleton& skeleton, const Pose& pose, const Motion& clip,
                 double time) {
  for (const Track& track : clip.tracks)
    if (track_of(motion, track.bone) == nullptr) motion.tracks.emplace_back().bone = track.bone;
  for (Track& track : motion.tracks) {
    const int parent = skeleton.bones[track.bone].parent;
    const Quat turned = parent == no_bone ? Quat::Identity() : Quat(pose[parent].turn);
    const Track* reference = track_of(clip, track.bone);
    turn(track, turned, reference == nullptr ? LocalMotion{} : reference->at(time));
  }
  return motion;
}

}  // namespace

Rig with_rest_at(const Rig& rig, const Motion& clip, double time) {
  const Pose pose = pose_at(rig.skeleton, clip, time);
  Rig made;
  made.warnings = rig.warnings;
  made.skeleton = skeleton_of(joints_at(rig.skeleton, pose, clip), "choose another time");
  for (const Clip& one : rig.clips) {
    made.clips.push_back(one);
    made.clips.back().motion = from_pose(one.motion, rig.skeleton, pose, clip, time);
  }
  return made;
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/rig/pose.h>

#include <sinew/rig/motion_checks.h>

namespace sinew {

PoseCursor::PoseCursor(const Skeleton& skeleton, const Motion& motion)
    : skeleton_(&skeleton), motion_(&motion), pose_(skeleton.size()) {
  for (const Bone& bone : skeleton.bones) {
    Link link{bone.parent,  -1,          bone.limits.any(), bone.head(),
              Vec3::Zero(), bone.axis(), bone.rest.rotation};
    if (bone.parent != no_bone) {
      const Bone& parent = skeleton.bones[static_cast<std::size_t>(bone.parent)];
      link.offset = bone.head() - parent.head();
      link.along = parent.axis().dot(link.offset) * parent.axis();
    }
    links_.push_back(link);
  }
  for (const Track& track : motion.tracks) {
    links_[static_cast<std::size_t>(track.bone)].track = static_cast<int>(cursors_.size());
    cursors_.emplace_back(track);
  }
}

/// A bone that does nothing by itself goes with its parent.
void PoseCursor::carry(const Link& link, const BonePose& parent, BonePose& pose) {
  const Vec3 offset = parent.turn * (link.offset + (parent.stretch - 1) * link.along);
  pose.turn = parent.turn;
  pose.frame.rotation = pose.turn * link.rest;
  pose.frame.origin = parent.frame.origin + offset;
  pose.velocity = parent.velocity + parent.angular_velocity.cross(offset) +
                  parent.turn * (parent.stretch_rate * link.along);
  pose.angular_velocity = parent.angular_velocity;
}

void PoseCursor::move(const Link& link, const LocalMotion& local, const BonePose& parent,
                      BonePose& pose) {
  const Mat3 rotation = parent.turn * local.rotation.toRotationMatrix();
  const Vec3 offset =
      parent.turn * (link.offset + (parent.stretch - 1) * link.along + local.translation);
  const Vec3 slide = local.velocity + parent.stretch_rate * link.along;
  pose.turn = rotation;
  pose.velocity = parent.velocity + parent.angular_velocity.cross(offset);
  pose.angular_velocity = parent.angular_velocity + parent.turn * local.angular_velocity;
  if (!slide.isZero(0)) pose.velocity += parent.turn * slide;
  if (local.twist != 0 || local.twist_rate != 0) {
    pose.turn = rotation * Eigen::AngleAxisd(local.twist, link.axis).toRotationMatrix();
    pose.angular_velocity += local.twist_rate * (rotation * link.axis);
  }
  pose.frame.rotation = pose.turn * link.rest;
  pose.frame.origin = parent.frame.origin + offset;
  pose.twist = local.twist;
  pose.stretch = local.stretch;
  pose.stretch_rate = local.stretch_rate;
}

const Pose& PoseCursor::at(double time) {
  const ClipMoment moment = clip_moment(*motion_, time);
  const BonePose scene;
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const Link& link = links_[i];
    const BonePose& parent =
        link.parent == no_bone ? scene : pose_[static_cast<std::size_t>(link.parent)];
    if (link.track < 0) {
      carry(link, parent, pose_[i]);
      continue;
    }
    const auto track = static_cast<std::size_t>(link.track);
    LocalMotion local = local_motion(motion_->tracks[track], moment, cursors_[track]);
    if (link.limited) limit(skeleton_->bones[i], local);
    move(link, local, parent, pose_[i]);
  }
  return pose_;
}

Pose pose_at(const Skeleton& skeleton, const Motion& motion, double time) {
  return PoseCursor(skeleton, motion).at(time);
}

Pose rest_pose(const Skeleton& skeleton) { return pose_at(skeleton, {}, 0); }

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
#include "rig/pose.h"

#include "rig/motion.h"

namespace sinew {
namespace {

/// Where the head of a bone has its place on the parent at rest; the scene's origin holds roots.
struct Joint {
  Vec3 offset = Vec3::Zero();  ///< from the parent's head, at rest
  Vec3 along = Vec3::Zero();   ///< its part along the parent, which stretches
};

Joint joint_of(const Bone& bone, const Bone* parent) {
  if (parent == nullptr) return {bone.head(), Vec3::Zero()};
  const Vec3 offset = bone.head() - parent->head();
  return {offset, parent->axis().dot(offset) * parent->axis()};
}

BonePose move(const Bone& bone, const LocalMotion& local, const BonePose& parent,
              const Joint& joint) {
  const Mat3 rotation = parent.turn * local.rotation.toRotationMatrix();
  const Vec3 offset =
      parent.turn * (joint.offset + (parent.stretch - 1) * joint.along + local.translation);
  const Vec3 axis = rotation * bone.axis();
  BonePose pose;
  pose.turn = rotation;
  if (local.twist != 0)
    pose.turn = rotation * Eigen::AngleAxisd(local.twist, bone.axis()).toRotationMatrix();
  pose.frame.rotation = pose.turn * bone.rest.rotation;
  pose.frame.origin = parent.frame.origin + offset;
  pose.velocity = parent.velocity + parent.angular_velocity.cross(offset) +
                  parent.turn * (local.velocity + parent.stretch_rate * joint.along);
  pose.angular_velocity =
      parent.angular_velocity + parent.turn * local.angular_velocity + local.twist_rate * axis;
  pose.twist = local.twist;
  pose.stretch = local.stretch;
  pose.stretch_rate = local.stretch_rate;
  return pose;
}

}  // namespace

Pose pose_at(const Skeleton& skeleton, const Motion& motion, double time) {
  const std::vector<LocalMotion> local = local_motions(skeleton, motion, time);
  const BonePose scene;
  Pose pose;
  pose.reserve(skeleton.size());
  for (std::size_t i = 0; i < skeleton.size(); ++i) {
    const Bone& bone = skeleton.bones[i];
    const bool root = bone.parent == no_bone;
    const auto parent = static_cast<std::size_t>(root ? 0 : bone.parent);
    pose.push_back(move(bone, local[i], root ? scene : pose[parent],
                        joint_of(bone, root ? nullptr : &skeleton.bones[parent])));
  }
  return pose;
}

Pose rest_pose(const Skeleton& skeleton) { return pose_at(skeleton, {}, 0); }

}  // namespace sinew

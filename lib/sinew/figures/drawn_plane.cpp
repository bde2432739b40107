// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/figures/drawn_plane.h>

#include <algorithm>
#include <cmath>

namespace sinew {
namespace {

constexpr double min_joint_turn = 0.02;  // rad: below it a joint does not turn
// Cosine between a plane's normal and the direction to the viewer.
constexpr double in_sight = 0.35;

/// The part of `vector` across the direction `along`, of length 1; zero where there is none.
Vec3 across(const Vec3& vector, const Vec3& along) {
  const Vec3 part = vector - vector.dot(along) * along;
  return part.norm() > 0.1 ? Vec3(part.normalized()) : Vec3(Vec3::Zero());
}

/// The size of what each bone holds, in any unit.
std::vector<double> sizes_of_bones(const RunFiles& run) {
  std::vector<double> sizes(run.skeleton.size());
  for (const std::int32_t bone : *run.body.bone)
    if (bone >= 0) ++sizes[static_cast<std::size_t>(bone)];
  for (double& size : sizes) size = std::cbrt(size);
  return sizes;
}

/// The scene's axis that points most to the viewer.
Vec3 axis_toward(const Vec3& viewer) {
  int axis = 0;
  viewer.cwiseAbs().maxCoeff(&axis);
  return (viewer[axis] < 0 ? -1 : 1) * Vec3::Unit(axis);
}

}  // namespace

void JointTurns::add(const FrameState& frame) {
  const std::vector<Bone>& bones = run_->skeleton.bones;
  for (std::size_t b = 0; b < frame.bones.size(); ++b) {
    if (bones[b].parent < 0) continue;
    const auto parent = static_cast<std::size_t>(bones[b].parent);
    const auto moved = [&](std::size_t bone) -> Mat3 {
      return frame.bones[bone].rotation * bones[bone].rest.rotation.transpose();
    };
    const Eigen::AngleAxisd turn(Mat3(moved(parent).transpose() * moved(b)));
    if (turn.angle() > turns_[b].angle) turns_[b] = {turn.angle(), turn.axis()};
  }
}

DrawnPlane::DrawnPlane(const RunFiles& run, const JointTurns& turns, const Mat3& view) {
  const Vec3 viewer = view.row(2);
  const std::vector<double> sizes = sizes_of_bones(run);
  const auto joint = std::max_element(
      turns.of_bones().begin(), turns.of_bones().end(),
      [&](const JointTurns::Turn& a, const JointTurns::Turn& b) {
        const auto weight = [&](const JointTurns::Turn& turn) {
          return turn.angle * sizes[static_cast<std::size_t>(&turn - turns.of_bones().data())];
        };
        return weight(a) < weight(b);
      });
  if (joint == turns.of_bones().end() || joint->angle < min_joint_turn) {
    rest_ = {bounds(positions_of(run.body.particles)).center(), axis_toward(viewer)};
    if (run.skeleton.size() == 1) bone_ = 0;
  } else {
    const Bone& bone =
        run.skeleton.bones[static_cast<std::size_t>(joint - turns.of_bones().begin())];
    const Vec3 along = bone.rest.rotation.col(0);
    Vec3 normal = across(joint->axis, along);
    if (std::abs(normal.dot(viewer)) < in_sight) normal = across(viewer, along);
    if (normal.isZero()) normal = across(view.row(1), along);
    rest_ = {bone.rest.origin, normal.dot(viewer) < 0 ? Vec3(-normal) : normal};
    bone_ = static_cast<std::size_t>(bone.parent);
  }
  if (bone_) bone_rest_ = run.skeleton.bones[*bone_].rest;
}

CutPlane DrawnPlane::at(const FrameState& frame) const {
  if (!bone_ || frame.bones.empty()) return rest_;
  const RigidFrame& now = frame.bones[*bone_];
  return {carried(rest_.point, bone_rest_, now),
          now.rotation * (bone_rest_.rotation.transpose() * rest_.normal)};
}

}  // namespace sinew

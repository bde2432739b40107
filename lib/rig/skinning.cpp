// SPDX-License-Identifier: GPL-3.0-or-later
#include "rig/skinning.h"

#include "core/parallel.h"

namespace sinew {
namespace {

constexpr std::size_t vertices_per_piece = 1024;

using Parts = std::span<const BoneWeight>;

template <class Move>
Points each_moved(const Points& rest, const BoneWeights& weights, const Move& move) {
  Points moved = rest;
  parallel_for(rest.size(), vertices_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (!weights.of(i).empty()) moved[i] = move(rest[i], weights.of(i));
  });
  return moved;
}

/// A rigid motion: turn by `real`, then shift; dual = shift real / 2.
struct DualQuaternion {
  Quat real, dual;
};

DualQuaternion motion_of(const Bone& bone, const BonePose& pose) {
  const Quat turn(pose.turn);
  const Vec3 shift = pose.frame.origin - pose.turn * bone.head();
  Quat dual = Quat(0, shift.x(), shift.y(), shift.z()) * turn;
  dual.coeffs() *= 0.5;
  return {turn, dual};
}

DualQuaternion blended(const std::vector<DualQuaternion>& motions, Parts parts) {
  DualQuaternion sum{Quat(0, 0, 0, 0), Quat(0, 0, 0, 0)};
  const Quat& heaviest = motions[parts.front().bone].real;
  for (const BoneWeight& part : parts) {
    const DualQuaternion& motion = motions[part.bone];
    const double weight = heaviest.dot(motion.real) < 0 ? -part.weight : part.weight;
    sum.real.coeffs() += weight * motion.real.coeffs();
    sum.dual.coeffs() += weight * motion.dual.coeffs();
  }
  const double length = sum.real.norm();
  sum.real.coeffs() /= length;
  sum.dual.coeffs() /= length;
  return sum;
}

Vec3 moved_by(const DualQuaternion& motion, const Vec3& point) {
  const Quat shift = motion.dual * motion.real.conjugate();
  return motion.real * point + 2 * shift.vec();
}

Vec3 stretched(const Vec3& point, Parts parts, const Skeleton& skeleton, const Pose& pose) {
  Vec3 longer = point;
  for (const BoneWeight& part : parts) {
    if (pose[part.bone].stretch == 1) continue;
    const Bone& bone = skeleton.bones[part.bone];
    const double along = bone.axis().dot(point - bone.head());
    longer += part.weight * (pose[part.bone].stretch - 1) * along * bone.axis();
  }
  return longer;
}

}  // namespace

Points linear_blend_skinned(const Points& rest, const BoneWeights& weights,
                            const Skeleton& skeleton, const Pose& pose) {
  return each_moved(rest, weights, [&](const Vec3& point, Parts parts) {
    Vec3 sum = Vec3::Zero();
    for (const BoneWeight& part : parts)
      sum += part.weight * pose[part.bone].carried(point, skeleton.bones[part.bone]);
    return sum;
  });
}

Points dual_quaternion_skinned(const Points& rest, const BoneWeights& weights,
                               const Skeleton& skeleton, const Pose& pose) {
  std::vector<DualQuaternion> motions;
  for (std::size_t b = 0; b < pose.size(); ++b)
    motions.push_back(motion_of(skeleton.bones[b], pose[b]));
  return each_moved(rest, weights, [&](const Vec3& point, Parts parts) -> Vec3 {
    return moved_by(blended(motions, parts), stretched(point, parts, skeleton, pose));
  });
}

}  // namespace sinew

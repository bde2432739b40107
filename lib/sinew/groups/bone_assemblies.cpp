// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/groups/bone_assemblies.h>

#include <cmath>

#include <sinew/body/body.h>
#include <sinew/world/world.h>

namespace sinew {
namespace {

constexpr double min_turn = 1e-3, min_shift = 1e-4;  // rad; in lengths of the bone
// Joints of thin bones on a wide one do not reach across it, in square roots of their sections.
constexpr double reach_of_joint = 1.5;

/// A bone relative to its parent.
RigidFrame relative(const Skeleton& skeleton, const Pose& pose, std::size_t bone) {
  const int parent = skeleton.bones[bone].parent;
  const RigidFrame& own = pose[bone].frame;
  if (parent == no_bone) return own;
  const RigidFrame& base = pose[static_cast<std::size_t>(parent)].frame;
  return {base.rotation.transpose() * (own.origin - base.origin),
          base.rotation.transpose() * own.rotation};
}

bool differ(const RigidFrame& a, const RigidFrame& b, double length) {
  const Quat turn(Mat3(a.rotation.transpose() * b.rotation));
  return rotation_vector(turn).norm() > min_turn ||
         (a.origin - b.origin).norm() > min_shift * length;
}

/// Bones that are stiff to each other have the same number: that of the first of them.
std::vector<int> assemblies_of(const Skeleton& skeleton, const std::vector<bool>& moves) {
  std::vector<int> assembly(skeleton.size());
  for (std::size_t b = 0; b < assembly.size(); ++b) {
    const int parent = skeleton.bones[b].parent;
    assembly[b] = parent == no_bone || moves[b] ? static_cast<int>(b)
                                                : assembly[static_cast<std::size_t>(parent)];
  }
  return assembly;
}

}  // namespace

std::vector<bool> moving_joints(const Skeleton& skeleton, const Motion& motion, const Pose& before,
                                TimeSpan span, int moments) {
  std::vector<bool> moves(skeleton.size(), false);
  PoseCursor cursor(skeleton, motion);
  for (int moment = 0; moment <= moments; ++moment) {
    const double fraction = static_cast<double>(moment) / moments;
    const Pose& now = cursor.at(span.begin + fraction * (span.end - span.begin));
    for (std::size_t b = 0; b < moves.size(); ++b)
      moves[b] = moves[b] || now[b].stretch != 1 ||
                 differ(relative(skeleton, before, b), relative(skeleton, now, b),
                        skeleton.bones[b].length);
  }
  return moves;
}

BoneAssemblies::BoneAssemblies(const Body& body, const std::vector<bool>& moves,
                               double joint_distance, std::span<const std::uint8_t> kept_free)
    : body_(body),
      assembly_(assemblies_of(body.skeleton, moves)),
      acted_(kept_free.begin(), kept_free.end()) {
  acted_.resize(body.rest.size(), 0);
  for (std::size_t b = 0; b < moves.size(); ++b)
    if (moves[b] && body.skeleton.bones[b].parent != no_bone)
      joints_.push_back({body.skeleton.bones[b].head(),
                         joint_distance * std::sqrt(body.binding.cross_section[b]),
                         reach_of_joint * std::sqrt(body.binding.cross_section[b])});
  if (!body.world) return;
  for (const Pinned& pin : body.world->pins) acted_[pin.particle] = 1;
  for (const Load& load : body.world->loads)
    for (const std::uint32_t particle : load.particles) acted_[particle] = 1;
  for (std::size_t i = 0; has_muscles(body) && i < acted_.size(); ++i)
    if (body.world->muscles.row[i] >= 0) acted_[i] = 1;
}

int BoneAssemblies::of(std::size_t i) const {
  const auto bones = body_.binding.of(i);
  if (acted_[i] != 0) return none;
  if (bones.empty()) return without_bones;
  const int assembly = assembly_[static_cast<std::size_t>(bones.front().bone)];
  for (const Influence& one : bones)
    if (assembly_[static_cast<std::size_t>(one.bone)] != assembly) return none;
  const Vec3 axis = body_.skeleton.bones[static_cast<std::size_t>(bones.front().bone)].axis();
  for (const Joint& joint : joints_) {
    const Vec3 from = body_.rest[i] - joint.place;
    const double along = axis.dot(from);
    if (std::abs(along) < joint.distance && (from - along * axis).norm() < joint.reach) return none;
  }
  return assembly;
}

}  // namespace sinew

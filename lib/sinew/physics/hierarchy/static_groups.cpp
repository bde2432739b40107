// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/physics/hierarchy/static_groups.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <sinew/core/cell_grid.h>
#include <sinew/core/parallel.h>
#include <sinew/core/particles.h>
#include <sinew/physics/forces.h>
#include <sinew/physics/world/world.h>

namespace sinew {
namespace {

constexpr int moments_of_motion = 400;
constexpr double least_turn = 1e-3, least_shift = 1e-4;  // rad; in lengths of the bone
// Joints of thin bones on a wide one do not reach across it, in square roots of their sections.
constexpr double reach_of_joint = 1.5;
constexpr std::size_t particles_per_grouping = 8192;

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
  return rotation_vector(turn).norm() > least_turn ||
         (a.origin - b.origin).norm() > least_shift * length;
}

/// Bones that are stiff to each other have the same number: that of the first of them.
std::vector<int> stiff_parts(const Skeleton& skeleton, const std::vector<bool>& moves) {
  std::vector<int> part(skeleton.size());
  for (std::size_t b = 0; b < part.size(); ++b) {
    const int parent = skeleton.bones[b].parent;
    part[b] = parent == no_bone || moves[b] ? static_cast<int>(b)
                                            : part[static_cast<std::size_t>(parent)];
  }
  return part;
}

/// What leaves particles free.
class Freedom {
 public:
  Freedom(const Body& body, const std::vector<bool>& moves, double joint_distance)
      : body_(body), part_(stiff_parts(body.skeleton, moves)), acted_(body.rest.size(), 0) {
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

  /// The part of the skeleton that a particle follows, or -1.
  int part_of(std::size_t i) const {
    const auto bones = body_.binding.of(i);
    if (bones.empty() || acted_[i] != 0) return -1;
    const int part = part_[static_cast<std::size_t>(bones.front().bone)];
    for (const Influence& one : bones)
      if (part_[static_cast<std::size_t>(one.bone)] != part) return -1;
    const Vec3 axis = body_.skeleton.bones[static_cast<std::size_t>(bones.front().bone)].axis();
    for (const Joint& joint : joints_) {
      const Vec3 from = body_.rest[i] - joint.place;
      const double along = axis.dot(from);
      if (std::abs(along) < joint.distance && (from - along * axis).norm() < joint.reach) return -1;
    }
    return part;
  }

 private:
  struct Joint {
    Vec3 place;
    double distance, reach;
  };

  const Body& body_;
  std::vector<int> part_;
  std::vector<std::uint8_t> acted_;
  std::vector<Joint> joints_;
};

/// Numbers what hangs together in each part; what is small becomes free.
void separate(const Body& body, std::size_t least, std::vector<std::int32_t>& group) {
  const double range = rest_neighbor_range(body.material.pair.r);
  const CellGrid grid(body.rest, range);
  std::vector<std::int32_t> found(group.size(), -1);
  std::int32_t next = 0;
  std::vector<std::uint32_t> members, near;
  for (std::uint32_t first = 0; first < group.size(); ++first) {
    if (group[first] < 0 || found[first] >= 0) continue;
    members.assign(1, first);
    found[first] = next;
    for (std::size_t n = 0; n < members.size(); ++n) {
      near.clear();
      append_neighbors(grid, body.rest, members[n], range, near);
      for (const std::uint32_t j : near)
        if (group[j] == group[first] && found[j] < 0) found[j] = next, members.push_back(j);
    }
    if (members.size() < least)
      for (const std::uint32_t i : members) group[i] = -1;
    ++next;
  }
  for (std::size_t i = 0; i < group.size(); ++i)
    if (group[i] >= 0) group[i] = found[i];
}

}  // namespace

std::vector<bool> moving_joints(const Skeleton& skeleton, const Motion& motion, double end) {
  std::vector<bool> moves(skeleton.size(), false);
  PoseCursor cursor(skeleton, motion);
  const Pose rest = rest_pose(skeleton);
  for (int moment = 0; moment <= moments_of_motion; ++moment) {
    const Pose& now = cursor.at(end * moment / moments_of_motion);
    for (std::size_t b = 0; b < moves.size(); ++b)
      moves[b] =
          moves[b] || now[b].stretch != 1 ||
          differ(relative(skeleton, rest, b), relative(skeleton, now, b), skeleton.bones[b].length);
  }
  return moves;
}

Grouping static_groups(const Body& body, const std::vector<bool>& moves,
                       const StaticGroups& options) {
  std::vector<std::int32_t> group(body.rest.size(), -1);
  const Freedom freedom(body, moves, options.joint_distance);
  parallel_for(group.size(), particles_per_grouping, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) group[i] = freedom.part_of(i);
  });
  separate(body, options.least, group);
  return make_grouping(body, std::move(group));
}

}  // namespace sinew

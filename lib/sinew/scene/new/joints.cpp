// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/new/new_scene.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <sinew/core/cell_grid.h>

namespace sinew {
namespace {

constexpr std::size_t max_joints = 12;
constexpr std::size_t few_particles = 10;          // particles that do not show a bend
constexpr double fewest_shown = 0.002;             // fraction of the particles
constexpr double bend_angle = 30;                  // degrees
constexpr double joint_every = 0.35, lasts = 0.7;  // s from one joint to the next, and of one
constexpr double already_bent = 0.1;               // sine of the angle at which a joint rests

/// The axis about which a joint bends: as it is bent already, or across the bone.
Vec3 bending_axis(const Bone& bone, const Bone& parent) {
  const Vec3 bent = parent.axis().cross(bone.axis());
  return bent.norm() > already_bent ? bent.normalized() : Vec3(bone.rest.rotation.col(1));
}

/// Where limbs run into the rest of the body when their joints bend.
class Room {
 public:
  explicit Room(const Body& body) : body_(body), grid_(body.rest, deep()) {}

  /// The axis of four, the preferred one first, about which the fewest particles do.
  Vec3 axis_for(int joint, const Vec3& preferred) const {
    const Vec3 across = body_.skeleton.bones[joint].axis().cross(preferred).normalized();
    Vec3 best = preferred;
    std::size_t fewest = hits(joint, preferred);
    for (const Vec3& axis : {Vec3(-preferred), across, Vec3(-across)})
      if (const std::size_t count = fewest > 0 ? hits(joint, axis) : 0; count < fewest)
        best = axis, fewest = count;
    return best;
  }

 private:
  /// Distance of particles of two limbs that run into each other; 2 r where they lie or slide
  /// beside each other.
  double deep() const { return 1.4 * body_.material.pair.r; }

  /// Particles of the limb that run into those of bones but the one above, on the way.
  std::size_t hits(int joint, const Vec3& axis) const {
    const std::vector<Bone>& bones = body_.skeleton.bones;
    std::vector<bool> below(bones.size());
    for (std::size_t b = 0; b < bones.size(); ++b)
      below[b] =
          static_cast<int>(b) == joint || (bones[b].parent != no_bone && below[bones[b].parent]);
    const Vec3 head = bones[joint].head();
    const auto hits_at = [&](const Vec3& bent) {
      bool hit = false;
      grid_.for_each_near(bent, [&](std::uint32_t j) {
        const int other = body_.binding.bone(j);
        hit = hit || (other != no_bone && !below[other] && other != bones[joint].parent &&
                      (bent - body_.rest[j]).norm() < deep());
      });
      return hit;
    };
    std::size_t count = 0;
    for (const double part : {1.0 / 3, 2.0 / 3, 1.0}) {
      const Quat turn(Eigen::AngleAxisd(part * radians(bend_angle), axis));
      for (std::size_t i = 0; i < body_.rest.size(); ++i)
        if (const int bone = body_.binding.bone(i); bone != no_bone && below[bone])
          count += hits_at(head + turn * (body_.rest[i] - head));
    }
    return count;
  }

  const Body& body_;
  CellGrid grid_;
};

TrackDefinition bending(const std::string& bone, const Vec3& axis, double begin) {
  TrackDefinition track;
  track.bone = bone;
  const auto add = [&](double time, double angle) {
    KeyDefinition& key = track.keys.emplace_back();
    key.time = std::round(time * 1000) / 1000, key.axis = axis, key.angle = angle;
  };
  if (begin > 0) add(0, 0);
  add(begin, 0), add(begin + lasts / 2, bend_angle), add(begin + lasts, 0);
  return track;
}

}  // namespace

std::vector<int> joints_that_skin_follows(const Body& body) {
  std::vector<std::size_t> counts(body.skeleton.size());
  for (std::size_t i = 0; i < body.rest.size(); ++i)
    if (const int bone = body.binding.bone(i); bone != no_bone) ++counts[bone];
  const std::size_t enough =
      std::max(few_particles,
               static_cast<std::size_t>(fewest_shown * static_cast<double>(body.rest.size())));
  std::vector<int> joints;
  for (std::size_t b = 0; b < counts.size(); ++b) {
    const int parent = body.skeleton.bones[b].parent;
    if (counts[b] >= enough && parent != no_bone && counts[parent] >= few_particles)
      joints.push_back(static_cast<int>(b));
  }
  std::stable_sort(joints.begin(), joints.end(),
                   [&](int a, int b) { return counts[a] > counts[b]; });
  joints.resize(std::min(joints.size(), max_joints));
  std::sort(joints.begin(), joints.end());
  return joints;
}

void bend_joints(const Body& body, NewChoices& choices) {
  const std::vector<int> joints = joints_that_skin_follows(body);
  if (joints.empty()) return;
  choices.settings.tracks.clear();
  const Room room(body);
  const Mat3 to_file = placement_of(choices.settings.skeleton).turn.transpose();
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const Bone& bone = body.skeleton.bones[joints[k]];
    const Vec3 usual = bending_axis(bone, body.skeleton.bones[bone.parent]);
    const Vec3 axis = to_file * room.axis_for(joints[k], usual);
    choices.settings.tracks.push_back(
        bending(bone.name, axis, joint_every * static_cast<double>(k)));
  }
  choices.settings.solver.duration =
      std::round(100 *
                 (joint_every * static_cast<double>(joints.size() - 1) + lasts + rest_after)) /
      100;
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
#include "rig/binding.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sinew {
namespace {

/// Where two bones meet, and the zone in which weights pass from parent to child.
struct Joint {
  int parent, child;
  Vec3 place, axis;  // the axis points into the child
  double length;     // of the zone along the axis, m

  /// The child's share at `point`: 0 on the parent's side of the zone, 1 beyond it.
  double share_of_child(const Vec3& point) const {
    return std::clamp(0.5 + (point - place).dot(axis) / length, 0.0, 1.0);
  }
};

double along(const Bone& bone, const Vec3& point) { return (point - bone.head()).dot(bone.axis()); }

Vec3 foot_on(const Bone& bone, const Vec3& point, double before, double beyond) {
  const double s = std::clamp(along(bone, point), -before, bone.length + beyond);
  return bone.head() + s * bone.axis();
}

std::vector<double> cross_sections(const Skeleton& skeleton, const std::vector<double>& volumes) {
  std::vector<double> sections(skeleton.size());
  for (std::size_t b = 0; b < skeleton.size(); ++b)
    sections[b] = volumes[b] / skeleton.bones[b].length;
  return sections;
}

std::vector<double> sections_by_nearest(const Points& rest, const Skeleton& skeleton,
                                        double particle_volume) {
  std::vector<double> volumes(skeleton.size(), 0.0);
  for (const Vec3& point : rest) volumes[nearest_bone(skeleton, point)] += particle_volume;
  return cross_sections(skeleton, volumes);
}

/// Joints where a child's head lies on its parent's tail, with a zone of positive length.
std::vector<Joint> joints_of(const Skeleton& skeleton, const std::vector<double>& section,
                             double joint_zone) {
  std::vector<Joint> joints;
  for (std::size_t b = 0; b < skeleton.size(); ++b) {
    const Bone& child = skeleton.bones[b];
    if (child.parent == no_bone) continue;
    const Bone& parent = skeleton.bones[child.parent];
    const bool touch = (child.head() - parent.tail()).norm() < 1e-6 * parent.length;
    const double length = joint_zone * std::sqrt((section[b] + section[child.parent]) / 2);
    const Vec3 axis = parent.axis() + child.axis();
    if (touch && length > 0 && axis.norm() > 1e-6)
      joints.push_back(
          {child.parent, static_cast<int>(b), child.head(), axis.normalized(), length});
  }
  return joints;
}

/// Bones and weights of a particle whose nearest bone is `bone`, heaviest first.
std::vector<Influence> shares(int bone, const Vec3& point, const std::vector<Joint>& joints) {
  std::vector<Influence> held{{bone, 1}};
  for (const Joint& joint : joints) {
    if (joint.parent != bone && joint.child != bone) continue;
    const double child = joint.share_of_child(point);
    const double other = joint.child == bone ? 1 - child : child;
    held.front().weight *= 1 - other;
    held.push_back({joint.child == bone ? joint.parent : joint.child, other});
  }
  std::erase_if(held, [](const Influence& influence) { return influence.weight <= 0; });
  double sum = 0;
  for (const Influence& influence : held) sum += influence.weight;
  for (Influence& influence : held) influence.weight /= sum;
  std::stable_sort(held.begin(), held.end(),
                   [](const Influence& a, const Influence& b) { return a.weight > b.weight; });
  return held;
}

/// How far feet may lie beyond each bone's head and tail: half of the zones there.
struct Reach {
  std::vector<double> before, beyond;
};

Reach reach_of(const Skeleton& skeleton, const std::vector<Joint>& joints) {
  Reach reach{std::vector<double>(skeleton.size(), 0.0), std::vector<double>(skeleton.size(), 0.0)};
  for (const Joint& joint : joints) {
    reach.before[joint.child] = std::max(reach.before[joint.child], joint.length / 2);
    reach.beyond[joint.parent] = std::max(reach.beyond[joint.parent], joint.length / 2);
  }
  return reach;
}

}  // namespace

int nearest_bone(const Skeleton& skeleton, const Vec3& point) {
  int nearest = no_bone;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t b = 0; b < skeleton.size(); ++b) {
    const double distance = (point - foot_on(skeleton.bones[b], point, 0, 0)).squaredNorm();
    if (distance < least) least = distance, nearest = static_cast<int>(b);
  }
  return nearest;
}

Binding bind_to_bones(const Points& rest, const Skeleton& skeleton, double particle_volume,
                      double joint_zone) {
  const auto sections = sections_by_nearest(rest, skeleton, particle_volume);
  const std::vector<Joint> joints = joints_of(skeleton, sections, joint_zone);
  const Reach reach = reach_of(skeleton, joints);
  std::vector<double> volumes(skeleton.size(), 0.0);
  Binding binding;
  binding.first.push_back(0);
  for (const Vec3& point : rest) {
    for (Influence influence : shares(nearest_bone(skeleton, point), point, joints)) {
      const int b = influence.bone;
      influence.foot = foot_on(skeleton.bones[b], point, reach.before[b], reach.beyond[b]);
      influence.rest_distance = (point - influence.foot).norm();
      volumes[b] += influence.weight * particle_volume;
      binding.influences.push_back(influence);
    }
    binding.first.push_back(static_cast<std::uint32_t>(binding.influences.size()));
  }
  binding.cross_section = cross_sections(skeleton, volumes);
  return binding;
}

}  // namespace sinew

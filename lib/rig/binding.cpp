// SPDX-License-Identifier: GPL-3.0-or-later
#include "rig/binding.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/parallel.h"

namespace sinew {
namespace {

constexpr std::size_t particles_per_piece = 4096;

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

/// Where on the axis, extended by `before` and `beyond`, the point nearest to `point` lies.
double foot_of(const Bone& bone, const Vec3& point, double before, double beyond) {
  return std::clamp(along(bone, point), -before, bone.length + beyond);
}

std::vector<double> cross_sections(const Skeleton& skeleton, const std::vector<double>& volumes) {
  std::vector<double> sections(skeleton.size());
  for (std::size_t b = 0; b < skeleton.size(); ++b)
    sections[b] = volumes[b] / skeleton.bones[b].length;
  return sections;
}

std::vector<int> nearest_bones(const Points& rest, const Skeleton& skeleton) {
  std::vector<int> nearest(rest.size());
  parallel_for(rest.size(), particles_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) nearest[i] = nearest_bone(skeleton, rest[i]);
  });
  return nearest;
}

std::vector<double> sections_by_nearest(const std::vector<int>& nearest, const Skeleton& skeleton,
                                        double particle_volume) {
  std::vector<double> volumes(skeleton.size(), 0.0);
  for (const int bone : nearest) volumes[bone] += particle_volume;
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

/// What binds one particle, its feet and distances included.
std::vector<Influence> influences_on(const Vec3& point, int nearest, const Skeleton& skeleton,
                                     const std::vector<Joint>& joints, const Reach& reach) {
  std::vector<Influence> held = shares(nearest, point, joints);
  for (Influence& influence : held) {
    const int b = influence.bone;
    const Bone& bone = skeleton.bones[b];
    influence.foot = foot_of(bone, point, reach.before[b], reach.beyond[b]);
    influence.rest_distance = (point - influence.foot_on(bone)).norm();
  }
  return held;
}

/// Puts the influences of consecutive pieces of particles together; `first` counts them.
std::vector<Influence> joined(std::vector<std::vector<Influence>> pieces,
                              const std::vector<std::uint32_t>& first) {
  std::vector<Influence> all(first.back());
  parallel_for(first.size() - 1, particles_per_piece, [&](std::size_t begin, std::size_t) {
    auto& piece = pieces[begin / particles_per_piece];
    std::copy(piece.begin(), piece.end(), all.begin() + first[begin]);
    piece = {};
  });
  return all;
}

}  // namespace

int nearest_bone(const Skeleton& skeleton, const Vec3& point) {
  int nearest = no_bone;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t b = 0; b < skeleton.size(); ++b) {
    const double distance = (point - skeleton.bones[b].head() -
                             foot_of(skeleton.bones[b], point, 0, 0) * skeleton.bones[b].axis())
                                .squaredNorm();
    if (distance < least) least = distance, nearest = static_cast<int>(b);
  }
  return nearest;
}

Binding bind_to_bones(const Points& rest, const Skeleton& skeleton, double particle_volume,
                      double joint_zone) {
  const std::vector<int> nearest = nearest_bones(rest, skeleton);
  const auto sections = sections_by_nearest(nearest, skeleton, particle_volume);
  const std::vector<Joint> joints = joints_of(skeleton, sections, joint_zone);
  const Reach reach = reach_of(skeleton, joints);
  Binding binding;
  binding.first.assign(rest.size() + 1, 0);
  std::vector<std::vector<Influence>> pieces((rest.size() + particles_per_piece - 1) /
                                             particles_per_piece);
  parallel_for(rest.size(), particles_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto held = influences_on(rest[i], nearest[i], skeleton, joints, reach);
      auto& piece = pieces[begin / particles_per_piece];
      piece.insert(piece.end(), held.begin(), held.end());
      binding.first[i + 1] = static_cast<std::uint32_t>(held.size());
    }
  });
  std::partial_sum(binding.first.begin(), binding.first.end(), binding.first.begin());
  binding.influences = joined(std::move(pieces), binding.first);
  std::vector<double> volumes(skeleton.size(), 0.0);
  for (const Influence& influence : binding.influences)  // in the order of the particles
    volumes[influence.bone] += influence.weight * particle_volume;
  binding.cross_section = cross_sections(skeleton, volumes);
  return binding;
}

}  // namespace sinew

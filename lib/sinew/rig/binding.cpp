// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/rig/binding.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <sinew/core/parallel.h>
#include <sinew/core/particles.h>
#include <sinew/rig/detail/inside_distance.h>
#include <sinew/rig/detail/joint_zones.h>

namespace sinew {
namespace {

constexpr std::size_t particles_per_piece = 4096;
constexpr double infinite = std::numeric_limits<double>::infinity();
// Fraction of a bone's length that feet of given weights may be beyond its ends. Bones of files
// share particles around joints, and a foot that stopped at the joint would rotate about it.
constexpr double beyond_ends = 0.5;

double along(const Bone& bone, const Vec3& point) { return (point - bone.head()).dot(bone.axis()); }

/// Where on the axis, extended by `before` and `beyond`, the point nearest to `point` lies.
double foot_of(const Bone& bone, const Vec3& point, double before, double beyond) {
  return std::clamp(along(bone, point), -before, bone.length + beyond);
}

double squared_distance(const Bone& bone, const Vec3& point) {
  return (point - bone.head() - foot_of(bone, point, 0, 0) * bone.axis()).squaredNorm();
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

/// What determines the bones of a particle.
struct Choice {
  const Points& rest;
  const Skeleton& skeleton;
  const BindOptions& options;
  std::vector<int> nearest;
  JointZones zones;
  std::vector<std::vector<BoneDistance>> inside;  ///< bones near each; empty: by straight distance

  double distance(std::size_t i, int bone) const {
    if (inside.empty()) return distance_to(skeleton.bones[bone], rest[i]);
    for (const BoneDistance& one : inside[i])
      if (one.bone == bone) return one.distance;
    return infinite;
  }
};

/// Nearest bones by paths inside; particles without a path get the nearest by straight distance.
std::size_t choose_inside(Choice& choice, double particle_volume) {
  const auto* near = choice.options.neighbors;
  const InsidePaths paths =
      near != nullptr ? inside_paths(choice.rest, choice.skeleton, choice.options.radius, *near)
                      : inside_paths(choice.rest, choice.skeleton, choice.options.radius);
  choice.inside = near_inside(paths, choice.skeleton, 0);
  choice.nearest = paths.straight_nearest;
  std::size_t unreached = 0;
  for (std::size_t i = 0; i < choice.inside.size(); ++i) {
    const int bone = nearest_of(choice.inside[i]).bone;
    if (bone != no_bone) choice.nearest[i] = bone;
    unreached += bone == no_bone;
  }
  choice.zones = joint_zones(choice.skeleton,
                             sections_by_nearest(choice.nearest, choice.skeleton, particle_volume),
                             choice.options.joint_zone);
  if (const double reach = choice.zones.longest(); reach > 0)
    choice.inside = near_inside(paths, choice.skeleton, reach);
  return unreached;
}

void choose_nearest(Choice& choice, double particle_volume) {
  choice.nearest = nearest_bones(choice.rest, choice.skeleton);
  choice.zones = joint_zones(choice.skeleton,
                             sections_by_nearest(choice.nearest, choice.skeleton, particle_volume),
                             choice.options.joint_zone);
}

std::vector<BoneWeight> weights_of(const Choice& choice, std::size_t i) {
  const auto& given = choice.options.weights;
  if (given && !given->of(i).empty()) return {given->of(i).begin(), given->of(i).end()};
  return weights_in_zones(choice.zones, choice.nearest[i], choice.rest[i],
                          [&](int bone) { return choice.distance(i, bone); });
}

Influence influence_of(const Choice& choice, const BoneWeight& one, const Vec3& point) {
  const Bone& bone = choice.skeleton.bones[one.bone];
  double before = choice.zones.before[one.bone], beyond = choice.zones.beyond[one.bone];
  if (choice.options.weights) before = beyond = beyond_ends * bone.length;
  return {one.bone, one.weight, foot_of(bone, point, before, beyond)};
}

const BoundRegion* region_of(const std::vector<BoundRegion>& regions, std::size_t i,
                             const Vec3& point) {
  const auto last = std::find_if(regions.rbegin(), regions.rend(),
                                 [&](const BoundRegion& region) { return region.holds(i, point); });
  return last == regions.rend() ? nullptr : &*last;
}

/// Adds the influences on one particle, including feet and distances; how many.
std::size_t add_influences(const Choice& choice, std::size_t i,
                           std::vector<Influence>& influences) {
  const Vec3& point = choice.rest[i];
  std::vector<BoneWeight> weights;
  if (const BoundRegion* region = region_of(choice.options.regions, i, point)) {
    if (region->bone != no_bone) weights.push_back({region->bone, 1});
  } else {
    weights = weights_of(choice, i);
    if (distance_to(choice.skeleton.bones[weights.front().bone], point) >
        choice.options.core_radius)
      weights.clear();
  }
  for (const BoneWeight& one : weights) influences.push_back(influence_of(choice, one, point));
  return weights.size();
}

/// Joins the influences of consecutive pieces of particles; `first` counts them.
std::vector<Influence> joined(std::vector<std::vector<Influence>> pieces,
                              const std::vector<std::uint32_t>& first) {
  std::vector<Influence> all(first.back());
  parallel_for(first.size() - 1, particles_per_piece, [&](std::size_t begin, std::size_t) {
    auto& piece = pieces[begin / particles_per_piece];
    std::copy(piece.begin(), piece.end(), all.begin() + first[begin]);
    piece = std::vector<Influence>();  // {} would keep its memory
  });
  return all;
}

Binding bound(const Choice& choice, double particle_volume) {
  const std::size_t n = choice.rest.size();
  Binding binding;
  binding.first.assign(n + 1, 0);
  std::vector<std::vector<Influence>> pieces((n + particles_per_piece - 1) / particles_per_piece);
  parallel_for(n, particles_per_piece, [&](std::size_t begin, std::size_t end) {
    auto& piece = pieces[begin / particles_per_piece];
    for (std::size_t i = begin; i < end; ++i)
      binding.first[i + 1] = static_cast<std::uint32_t>(add_influences(choice, i, piece));
  });
  std::partial_sum(binding.first.begin(), binding.first.end(), binding.first.begin());
  binding.influences = joined(std::move(pieces), binding.first);
  std::vector<double> volumes(choice.skeleton.size(), 0.0);
  for (const Influence& influence : binding.influences)  // in the order of the particles
    volumes[influence.bone] += influence.weight * particle_volume;
  binding.cross_section = cross_sections(choice.skeleton, volumes);
  return binding;
}

Binding bound_by(const Points& rest, const Skeleton& skeleton, const BindOptions& options,
                 double particle_volume) {
  if (skeleton.size() == 0) {
    Binding none;
    none.first.assign(rest.size() + 1, 0);
    return none;
  }
  Choice choice{rest, skeleton, options, {}, {}, {}};
  std::size_t unreached = 0;
  if (options.inside)
    unreached = choose_inside(choice, particle_volume);
  else
    choose_nearest(choice, particle_volume);
  Binding binding = bound(choice, particle_volume);
  binding.unreached = unreached;
  return binding;
}

}  // namespace

bool BoundRegion::holds(std::size_t particle, const Vec3& rest) const {
  return std::binary_search(ids.begin(), ids.end(), particle) || (box && box->contains(rest)) ||
         (rest - center).norm() <= radius;
}

double distance_to(const Bone& bone, const Vec3& point) {
  return std::sqrt(squared_distance(bone, point));
}

int nearest_bone(const Skeleton& skeleton, const Vec3& point) {
  int nearest = no_bone;
  double least = infinite;
  for (std::size_t b = 0; b < skeleton.size(); ++b) {
    const double distance = squared_distance(skeleton.bones[b], point);
    if (distance < least) least = distance, nearest = static_cast<int>(b);
  }
  return nearest;
}

Binding bind_to_bones(const Points& rest, const Skeleton& skeleton, const BindOptions& options) {
  return bound_by(rest, skeleton, options, volume_per_particle(options.radius));
}

Binding bind_to_bones(const Points& rest, const Skeleton& skeleton, double particle_volume,
                      double joint_zone) {
  BindOptions options;
  options.joint_zone = joint_zone;
  return bound_by(rest, skeleton, options, particle_volume);
}

}  // namespace sinew

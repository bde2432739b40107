// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/rig/detail/inside_distance.h>

#include <algorithm>
#include <limits>
#include <queue>
#include <tuple>

#include <sinew/core/parallel.h>
#include <sinew/core/particles.h>
#include <sinew/rig/binding.h>

namespace sinew {
namespace {

constexpr double unreached = std::numeric_limits<double>::infinity();
constexpr std::size_t particles_per_ray_task = 4096;
// The largest void of closest packing is sqrt(2) radii from the next particle.
constexpr double around_bone = 1.5, beyond_nearest = 0.5;  // radii
// Lattice paths over straight ones: at most sqrt(9 / 8), along [111] of FCC.
constexpr double detour_of_lattice = 1.061;

struct Step {
  double distance;
  int bone;
  std::uint32_t particle;
  /// Reversed: the nearest, then the lower bone, then the lower particle is on top.
  bool operator<(const Step& other) const {
    return std::tie(distance, bone, particle) >
           std::tie(other.distance, other.bone, other.particle);
  }
};

void begin_at(const InsidePaths& paths, const Skeleton& skeleton, int bone,
              std::vector<Step>& starts) {
  for (const std::uint32_t i : paths.starts[bone])
    starts.push_back({distance_to(skeleton.bones[bone], paths.points[i]), bone, i});
}

/// Dijkstra's algorithm; paths end at `limit` (m).
std::vector<BoneDistance> walk(const InsidePaths& paths, const std::vector<Step>& starts,
                               double limit) {
  std::vector<BoneDistance> found(paths.points.size(), {no_bone, unreached});
  std::vector<bool> reached(paths.points.size());
  std::priority_queue<Step> queue;
  const auto offer = [&](std::uint32_t i, int bone, double distance) {
    BoneDistance& best = found[i];
    if (distance > limit || std::tie(distance, bone) >= std::tie(best.distance, best.bone)) return;
    best = {bone, distance};
    queue.push({distance, bone, i});
  };
  for (const Step& one : starts) offer(one.particle, one.bone, one.distance);
  while (!queue.empty()) {
    const Step step = queue.top();
    queue.pop();
    if (reached[step.particle]) continue;
    reached[step.particle] = true;
    for (const std::uint32_t j : paths.links.of(step.particle))
      if (!reached[j])
        offer(j, step.bone, step.distance + (paths.points[j] - paths.points[step.particle]).norm());
  }
  return found;
}

/// Particles that touch each one, and those that touch these.
NeighborLists links_of(const NeighborLists& touching) {
  std::vector<std::vector<std::uint32_t>> rows(touching.size());
  parallel_for(touching.size(), particles_per_ray_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      std::vector<std::uint32_t>& row = rows[i];
      for (const std::uint32_t j : touching.of(i)) {
        row.push_back(j);
        for (const std::uint32_t k : touching.of(j))
          if (k != i) row.push_back(k);
      }
      std::sort(row.begin(), row.end());
      row.erase(std::unique(row.begin(), row.end()), row.end());
    }
  });
  NeighborLists links;
  links.first.push_back(0);
  for (const auto& row : rows) {
    links.neighbor.insert(links.neighbor.end(), row.begin(), row.end());
    links.first.push_back(static_cast<std::uint32_t>(links.neighbor.size()));
  }
  return links;
}

/// The straight distance, or that of the path inside where it is a detour.
BoneDistance without_lattice(const InsidePaths& paths, const Skeleton& skeleton, std::uint32_t i,
                             const BoneDistance& path) {
  const double straight = distance_to(skeleton.bones[path.bone], paths.points[i]);
  return {path.bone, std::max(straight, path.distance / detour_of_lattice)};
}

/// Paths from one bone, up to `limit` (m).
std::vector<BoneDistance> paths_from(const InsidePaths& paths, const Skeleton& skeleton, int bone,
                                     double limit) {
  std::vector<Step> starts;
  begin_at(paths, skeleton, bone, starts);
  return walk(paths, starts, limit);
}

}  // namespace

InsidePaths inside_paths(const Points& rest, const Skeleton& skeleton, double radius) {
  return inside_paths(rest, skeleton, radius, neighbors_within(rest, rest_neighbor_range(radius)));
}

InsidePaths inside_paths(const Points& rest, const Skeleton& skeleton, double radius,
                         const NeighborLists& touching) {
  InsidePaths paths{links_of(touching), rest, {}, {}};
  std::vector<double> distance(rest.size());
  paths.straight_nearest.resize(rest.size());
  parallel_for(rest.size(), particles_per_ray_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      paths.straight_nearest[i] = nearest_bone(skeleton, rest[i]);
      distance[i] = distance_to(skeleton.bones[paths.straight_nearest[i]], rest[i]);
    }
  });
  std::vector<double> least(skeleton.size(), unreached);
  for (std::size_t i = 0; i < rest.size(); ++i) {
    double& nearest = least[paths.straight_nearest[i]];
    nearest = std::min(nearest, distance[i]);
  }
  paths.starts.resize(skeleton.size());
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const int bone = paths.straight_nearest[i];
    if (distance[i] <= std::max(around_bone * radius, least[bone] + beyond_nearest * radius))
      paths.starts[bone].push_back(static_cast<std::uint32_t>(i));
  }
  return paths;
}

std::vector<std::vector<BoneDistance>> near_inside(const InsidePaths& paths,
                                                   const Skeleton& skeleton, double reach) {
  std::vector<Step> starts;
  for (std::size_t b = 0; b < skeleton.size(); ++b)
    begin_at(paths, skeleton, static_cast<int>(b), starts);
  const std::vector<BoneDistance> nearest = walk(paths, starts, unreached);
  const auto limit = [&](double path) { return detour_of_lattice * (path + reach); };
  double longest = 0;
  for (const BoneDistance& one : nearest)
    if (one.bone != no_bone) longest = std::max(longest, one.distance);
  std::vector<std::vector<BoneDistance>> near(paths.points.size());
  for (std::size_t b = 0; b < skeleton.size(); ++b) {
    const auto found = paths_from(paths, skeleton, static_cast<int>(b), limit(longest));
    for (std::uint32_t i = 0; i < found.size(); ++i)
      if (found[i].bone != no_bone && found[i].distance <= limit(nearest[i].distance))
        near[i].push_back(without_lattice(paths, skeleton, i, found[i]));
  }
  return near;
}

BoneDistance nearest_of(const std::vector<BoneDistance>& near) {
  BoneDistance nearest{no_bone, unreached};
  for (const BoneDistance& one : near)
    if (one.distance < nearest.distance) nearest = one;
  return nearest;
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
#include "rig/inside_distance.h"

#include <algorithm>
#include <limits>
#include <queue>
#include <tuple>

#include "core/closest_packing.h"
#include "core/parallel.h"
#include "rig/binding.h"

namespace sinew {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr std::size_t particles_per_piece = 4096;
// The widest hole of closest packing leaves sqrt(2) radii to the next particle.
constexpr double around_bone = 1.5, beyond_nearest = 0.5;  // radii

struct Step {
  double distance;
  int bone;
  std::uint32_t particle;
  /// Later steps first: the nearest, then the lower bone, then the lower particle is on top.
  bool operator<(const Step& other) const {
    return std::tie(distance, bone, particle) >
           std::tie(other.distance, other.bone, other.particle);
  }
};

using Queue = std::priority_queue<Step>;

void begin_at(const InsideWays& ways, const Skeleton& skeleton, int bone, Queue& queue) {
  for (const std::uint32_t i : ways.starts[bone])
    queue.push({distance_to(skeleton.bones[bone], ways.points[i]), bone, i});
}

/// Dijkstra: what leaves the queue first is the nearest. Ways longer than `limit(particle)` end.
template <class Limit>
std::vector<BoneDistance> walk(const InsideWays& ways, Queue queue, const Limit& limit) {
  std::vector<BoneDistance> found(ways.points.size(), {no_bone, infinite});
  while (!queue.empty()) {
    const Step step = queue.top();
    queue.pop();
    if (found[step.particle].bone != no_bone || step.distance > limit(step.particle)) continue;
    found[step.particle] = {step.bone, step.distance};
    for (const std::uint32_t j : ways.links.of(step.particle))
      if (found[j].bone == no_bone)
        queue.push(
            {step.distance + (ways.points[j] - ways.points[step.particle]).norm(), step.bone, j});
  }
  return found;
}

}  // namespace

InsideWays inside_ways(const Points& rest, const Skeleton& skeleton, double radius) {
  InsideWays ways{neighbours_within(rest, rest_neighbour_range(radius)), rest, {}, {}};
  std::vector<double> distance(rest.size());
  ways.straight_nearest.resize(rest.size());
  parallel_for(rest.size(), particles_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      ways.straight_nearest[i] = nearest_bone(skeleton, rest[i]);
      distance[i] = distance_to(skeleton.bones[ways.straight_nearest[i]], rest[i]);
    }
  });
  std::vector<double> least(skeleton.size(), infinite);
  for (std::size_t i = 0; i < rest.size(); ++i) {
    double& nearest = least[ways.straight_nearest[i]];
    nearest = std::min(nearest, distance[i]);
  }
  ways.starts.resize(skeleton.size());
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const int bone = ways.straight_nearest[i];
    if (distance[i] <= std::max(around_bone * radius, least[bone] + beyond_nearest * radius))
      ways.starts[bone].push_back(static_cast<std::uint32_t>(i));
  }
  return ways;
}

std::vector<BoneDistance> nearest_inside(const InsideWays& ways, const Skeleton& skeleton) {
  Queue queue;
  for (std::size_t b = 0; b < skeleton.size(); ++b)
    begin_at(ways, skeleton, static_cast<int>(b), queue);
  return walk(ways, std::move(queue), [](std::uint32_t) { return infinite; });
}

std::vector<std::vector<BoneDistance>> near_inside(const InsideWays& ways, const Skeleton& skeleton,
                                                   const std::vector<BoneDistance>& nearest,
                                                   double reach) {
  std::vector<std::vector<BoneDistance>> near(ways.points.size());
  for (std::size_t b = 0; b < skeleton.size(); ++b) {
    Queue queue;
    begin_at(ways, skeleton, static_cast<int>(b), queue);
    // A way that is too long anywhere leads to places for which it is too long as well.
    const auto found =
        walk(ways, std::move(queue), [&](std::uint32_t i) { return nearest[i].distance + reach; });
    for (std::size_t i = 0; i < near.size(); ++i)
      if (found[i].bone != no_bone) near[i].push_back(found[i]);
  }
  return near;
}

}  // namespace sinew

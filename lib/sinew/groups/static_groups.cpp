// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/groups/static_groups.h>

#include <algorithm>

#include <sinew/body/body.h>
#include <sinew/core/cell_grid.h>
#include <sinew/core/parallel.h>
#include <sinew/core/particles.h>

namespace sinew {
namespace {

constexpr int moments_of_motion = 400;

constexpr std::size_t particles_per_grouping = 8192;

}  // namespace

void separate(const NeighborLists& near, std::size_t least, std::vector<std::int32_t>& group) {
  std::vector<std::int32_t> found(group.size(), -1);
  std::int32_t next = 0;
  std::vector<std::uint32_t> members;
  for (std::uint32_t first = 0; first < group.size(); ++first) {
    if (group[first] < 0 || found[first] >= 0) continue;
    members.assign(1, first);
    found[first] = next;
    for (std::size_t n = 0; n < members.size(); ++n)
      for (const std::uint32_t j : near.of(members[n]))
        if (group[j] == group[first] && found[j] < 0) found[j] = next, members.push_back(j);
    if (members.size() < least)
      for (const std::uint32_t i : members) group[i] = -1;
    ++next;
  }
  for (std::size_t i = 0; i < group.size(); ++i)
    if (group[i] >= 0) group[i] = found[i];
}

std::vector<bool> moving_joints(const Skeleton& skeleton, const Motion& motion, double end) {
  return moving_joints(skeleton, motion, rest_pose(skeleton), {0, end}, moments_of_motion);
}

Grouping static_groups(const Body& body, const std::vector<bool>& moves, const GroupSizes& sizes) {
  std::vector<std::int32_t> group(body.rest.size(), -1);
  // Numbers from `first` on, of particles that are in no group yet.
  const auto group_beyond = [&](double distance, std::int32_t first) {
    const BoneAssemblies assemblies(body, moves, distance, sizes.kept_free);
    parallel_for(group.size(), particles_per_grouping, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        if (const int assembly = assemblies.of(i); assembly >= 0 && group[i] < 0)
          group[i] = first + assembly;
    });
  };
  const SharedNeighbors shared = neighbors_of(body);
  const NeighborLists& near = shared->nearest;
  if (sizes.cubic_distance) {
    group_beyond(*sizes.cubic_distance, 0);
    separate(near, sizes.min_cubic, group);
    free_sheets(body, group);
  }
  group_beyond(sizes.joint_distance, static_cast<std::int32_t>(group.size()));
  separate(near, sizes.min_particles, group);
  return make_grouping(body, std::move(group), sizes.cubic_from());
}

}  // namespace sinew

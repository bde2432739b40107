// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/groups/kept_free.h>

#include <algorithm>
#include <limits>

#include <sinew/body/body.h>
#include <sinew/core/cell_grid.h>
#include <sinew/core/particles.h>

namespace sinew {
namespace {

constexpr std::uint32_t nobody = std::numeric_limits<std::uint32_t>::max();

/// What each learns from its neighbors is which of the particles at the surface is nearest.
void free_near_surface(const Body& body, double distance, std::vector<std::uint8_t>& free) {
  const double r = body.material.pair.r;
  const SharedNeighbors shared = neighbors_of(body);
  const NeighborLists& near = shared->nearest;
  std::vector<std::uint32_t> nearest(body.rest.size(), nobody), known;
  for (std::uint32_t i = 0; i < nearest.size(); ++i)
    if (near.of(i).size() < max_neighbors_at_rest) nearest[i] = i, known.push_back(i);
  const auto apart = [&](std::uint32_t i, std::uint32_t from) {
    return (body.rest[i] - body.rest[from]).norm();
  };
  for (std::size_t n = 0; n < known.size(); ++n) {
    const std::uint32_t i = known[n], from = nearest[i];
    if (apart(i, from) + r >= distance) continue;
    free[i] = 1;
    for (const std::uint32_t j : near.of(i))
      if (nearest[j] == nobody || apart(j, from) < apart(j, nearest[j]) - 1e-6 * r)
        nearest[j] = from, known.push_back(j);
  }
}

}  // namespace

std::vector<std::uint8_t> kept_free(const Body& body, const AskedFree& asked) {
  if (asked.surface_distance <= 0 && !asked.region && asked.bones.empty()) return {};
  std::vector<std::uint8_t> free(body.rest.size(), 0);
  for (std::size_t i = 0; i < free.size(); ++i) {
    const auto influences = body.binding.of(i);
    const bool by_bone =
        std::any_of(influences.begin(), influences.end(), [&](const Influence& one) {
          return std::find(asked.bones.begin(), asked.bones.end(), one.bone) != asked.bones.end();
        });
    if (by_bone || (asked.region && asked.region->contains(body.rest[i]))) free[i] = 1;
  }
  if (asked.surface_distance > 0) free_near_surface(body, asked.surface_distance, free);
  return free;
}

}  // namespace sinew

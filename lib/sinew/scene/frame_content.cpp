// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/frame_content.h>

#include <algorithm>
#include <string>

#include <sinew/core/arrays.h>
#include <sinew/core/cell_grid.h>
#include <sinew/core/error.h>
#include <sinew/core/particles.h>
#include <sinew/material/laws.h>
#include <sinew/world/world.h>

namespace sinew {

namespace {

/// What strain is found from takes 500 bytes per particle: larger bodies have it on request.
constexpr std::size_t max_particles_with_strain = 200'000;

/// 1 for particles whose neighbors all have all of theirs.
std::vector<std::uint8_t> deep_inside(const NeighborLists& near) {
  const auto has_all = [&](std::uint32_t i) { return near.of(i).size() >= max_neighbors_at_rest; };
  std::vector<std::uint8_t> inside(near.size(), 0);
  for (std::uint32_t i = 0; i < inside.size(); ++i) {
    const auto around = near.of(i);
    inside[i] = has_all(i) && std::all_of(around.begin(), around.end(), has_all) ? 1 : 0;
  }
  return inside;
}

}  // namespace

std::vector<std::int32_t> written_particles(const OutputSettings& output, const Points& rest,
                                            double radius, const SharedNeighbors& near) {
  std::vector<std::int32_t> ids;
  if (!output.region && output.inside_every == 1) return ids;
  Box region;
  if (output.region) {
    const auto& [x0, y0, z0, x1, y1, z1] = *output.region;
    region = Box(Vec3(x0, y0, z0), Vec3(x1, y1, z1));
  }
  std::vector<std::uint8_t> inside;
  if (output.inside_every > 1)
    inside =
        deep_inside(near ? near->nearest : neighbors_within(rest, rest_neighbor_range(radius)));
  int met = 0;  // number of those inside
  for (std::size_t i = 0; i < rest.size(); ++i) {
    if (output.region && !region.contains(rest[i])) continue;
    if (!inside.empty() && inside[i] != 0 && met++ % output.inside_every != 0) continue;
    ids.push_back(static_cast<std::int32_t>(i));
  }
  if (ids.empty())
    throw bad_input("no particle is in output.region at rest",
                    "give the least and the greatest corner of a box that meets the body, in "
                    "meters, as in [0, 0, 0, 0.1, 0.1, 0.1]");
  return ids;
}

std::string words_asked_for(const OutputSettings& output, const Body& body) {
  std::string words = output.arrays;
  const bool stress_is_lost = bonds_change(body.material) || has_muscles(body) ||
                              output.region.has_value() || output.inside_every > 1;
  if (stress_is_lost && output.only.empty()) words += " von_mises";
  return words;
}

std::string words_for_arrays(const OutputSettings& output, const Body& body) {
  const bool with_strain = output.only.empty() && body.rest.size() <= max_particles_with_strain;
  return words_asked_for(output, body) + (with_strain ? " strain_eq" : "");
}

std::vector<std::string_view> additional_arrays(const OutputSettings& output, const Body& body) {
  RequestedArrays found = requested_arrays(words_for_arrays(output, body));
  found.measured.insert(found.measured.end(), found.stepped.begin(), found.stepped.end());
  return found.measured;
}

ContentOfSkin content_of_skin(const OutputSettings& output, const Body& body) {
  ContentOfSkin content{skin_arrays(output.skin), {}};
  if (!content.named.usual || body.rest.size() > max_particles_with_strain) return content;
  const auto& named = content.named.requested.measured;
  const auto add = [&](std::string_view name) {
    if (std::find(named.begin(), named.end(), name) == named.end()) content.usual.push_back(name);
  };
  add("strain_eq");
  if (law_of(body.material).has_bonds) add("von_mises");
  return content;
}

double written_fraction(const OutputSettings& output, const Points& rest, double radius,
                        const SharedNeighbors& near) {
  const std::size_t chosen = written_particles(output, rest, radius, near).size();
  const double of_particles =
      chosen == 0 ? 1 : static_cast<double>(chosen) / static_cast<double>(rest.size());
  return of_particles / output.every;
}

}  // namespace sinew

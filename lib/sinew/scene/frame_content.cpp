// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/frame_content.h>

#include <string>

#include <sinew/core/arrays.h>
#include <sinew/core/error.h>
#include <sinew/physics/laws.h>
#include <sinew/physics/world/world.h>

namespace sinew {

std::vector<std::int32_t> written_particles(const OutputSettings& output, const Points& rest) {
  std::vector<std::int32_t> ids;
  if (!output.region) return ids;
  const auto& [x0, y0, z0, x1, y1, z1] = *output.region;
  const Box region(Vec3(x0, y0, z0), Vec3(x1, y1, z1));
  for (std::size_t i = 0; i < rest.size(); ++i)
    if (region.contains(rest[i])) ids.push_back(static_cast<std::int32_t>(i));
  if (ids.empty())
    throw bad_input("no particle is in output.region at rest",
                    "give the least and the greatest corner of a box that meets the body, in "
                    "meters, as in [0, 0, 0, 0.1, 0.1, 0.1]");
  return ids;
}

std::string words_for_arrays(const OutputSettings& output, const Body& body) {
  std::string words = output.arrays;
  const bool stress_is_lost =
      bonds_change(body.material) || has_muscles(body) || output.region.has_value();
  if (stress_is_lost && output.only.empty()) words += " von_mises";
  return words;
}

std::vector<std::string_view> additional_arrays(const OutputSettings& output, const Body& body) {
  return requested_arrays(words_for_arrays(output, body));
}

double written_share(const OutputSettings& output, const Points& rest) {
  const std::size_t chosen = written_particles(output, rest).size();
  const double of_particles =
      chosen == 0 ? 1 : static_cast<double>(chosen) / static_cast<double>(rest.size());
  return of_particles / output.every;
}

}  // namespace sinew

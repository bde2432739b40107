// SPDX-License-Identifier: GPL-3.0-or-later
// Particles that stay free because a scene asks for it.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <sinew/core/vector.h>

namespace sinew {

struct Body;

struct AskedFree {
  double surface_distance = 0;     ///< m: nearer than this to the surface
  std::optional<Box> region = {};  ///< m: in this box at rest, its border included
  std::vector<int> bones = {};     ///< what any of these holds
};

/// Marks by particle id: 1 stays free. Empty where nothing is asked for. The surface is taken to be
/// a radius outside of particles of FCC that lack neighbors.
std::vector<std::uint8_t> kept_free(const Body& body, const AskedFree& asked);

}  // namespace sinew

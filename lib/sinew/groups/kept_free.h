// SPDX-License-Identifier: GPL-3.0-or-later
// Particles that stay free: because a scene asks for it, or because a group there would be too
// stiff. Under an indenter a body is deformed about as deep as the contact is wide, and where that
// is wide about as deep as the body: groups that begin there change the force by less than 5 %
// (README.md). Width of a body: the square root of the cross-section of what a bone carries.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <sinew/core/vector.h>
#include <sinew/rig/motion.h>

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

/// Marks what obstacles come nearer to than two widths of their contact, from a quarter of the
/// body's width to all of it, until `end` (s), while bones carry the particles rigidly. Some more
/// may be marked. Empty without obstacles. In parallel.
std::vector<std::uint8_t> near_obstacles(const Body& body, const Motion& motion, double end);

/// Marks what is within the body's width of surfaces that bones carry into another body. Some more
/// may be marked. Empty where none meet. In parallel.
std::vector<std::uint8_t> touching_bodies(const Body& body, const Motion& motion, double end);

}  // namespace sinew

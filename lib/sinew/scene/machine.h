// SPDX-License-Identifier: GPL-3.0-or-later
// The testing machine of a scene: its supports, loads and probes, made for its particles.
//
//     const ParticleParts parts(settings, body, files.surface, components);
//     add_machine(settings, body, parts, world);
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <sinew/scene/particle_parts.h>
#include <sinew/world/world.h>

namespace sinew {

/// Path of an entry of a scene's list, as errors name it: "supports[0]".
std::string path_of_one(const char* list, std::size_t index);

/// Adds the lists `supports` and `loads` to a world that has its pins. Throws bad input, with the
/// scene's line, for parts without particles or faces, and for supports that contradict each other.
void add_machine(const Settings& settings, const Body& body, const ParticleParts& parts,
                 World& world);

/// A part or a point of the body that is measured.
struct Probe {
  std::string name;
  std::vector<std::uint32_t> particles;  ///< ids
  std::vector<double> weight;            ///< weight of each in its means; sums to 1
  bool is_point = false;                 ///< whether it follows the particles
};

/// Throws bad input as add_machine() does.
std::vector<Probe> probes_of(const Settings& settings, const Body& body,
                             const ParticleParts& parts);

}  // namespace sinew

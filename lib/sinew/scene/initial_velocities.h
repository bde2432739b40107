// SPDX-License-Identifier: GPL-3.0-or-later
// Velocities with which the meshes of a scene begin: body.velocity and body.angular_velocity, and
// those of each entry of `bodies`.
//
//     const std::vector<Thrown> thrown = thrown_parts(settings, surface, body.rest);
//     set_initial_velocities(thrown, body, particles);
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <sinew/body/body.h>
#include <sinew/core/particles.h>
#include <sinew/mesh/surface.h>
#include <sinew/settings/settings.h>

namespace sinew {

/// What fills a mesh that begins with a velocity.
struct Thrown {
  Vec3 velocity, spin;                   ///< m/s, rad/s
  std::vector<std::uint32_t> particles;  ///< ids, ascending
};

std::vector<Thrown> thrown_parts(const Settings& settings, const Surface& surface,
                                 const Points& rest);

/// Gives each part the motion of a rigid body, v + w x (x - c), about its center of mass c where
/// its particles are; all others keep their velocities. `particles` by id.
void set_initial_velocities(std::span<const Thrown> thrown, const Body& body, Particles& particles);

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/initial_velocities.h>

#include <sinew/scene/body_mesh.h>

namespace sinew {

std::vector<Thrown> thrown_parts(const Settings& settings, const Surface& surface,
                                 const Points& rest) {
  if (!settings.moves_initially()) return {};
  std::vector<Thrown> parts;
  const auto add = [&](const BodyOptions& body) {
    parts.push_back({body.velocity, radians(1) * body.angular_velocity, {}});
  };
  add(settings.body);
  for (const PartOptions& part : settings.bodies) add(part.body);
  const std::vector<std::size_t> mesh = meshes_of_particles(settings, surface, rest);
  for (std::uint32_t i = 0; i < mesh.size(); ++i) parts[mesh[i]].particles.push_back(i);
  std::erase_if(parts, [](const Thrown& part) {
    return part.particles.empty() || (part.velocity.isZero(0) && part.spin.isZero(0));
  });
  return parts;
}

void set_initial_velocities(std::span<const Thrown> thrown, const Body& body,
                            Particles& particles) {
  for (const Thrown& part : thrown) {
    double mass = 0;
    Vec3 center = Vec3::Zero();
    for (const std::uint32_t i : part.particles) {
      const double m = mass_of(body, i, particles.mass);
      mass += m, center += m * particles.position(i);
    }
    center /= mass;
    for (const std::uint32_t i : part.particles)
      particles.set_velocity(i, part.velocity + part.spin.cross(particles.position(i) - center));
  }
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of a scene's body at rest, as materials, supports, loads and probes name them: particles,
// and faces of the surface.
//
//     const ParticleParts parts(settings, body, surface, components);
//     const auto held = parts.particles(settings.supports[0].part, "supports[0]");
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <sinew/body/body.h>
#include <sinew/core/triangles.h>
#include <sinew/settings/settings.h>

namespace sinew {

/// "from [0, 0, 0] to [1, 1, 2] m": the box around points, as errors name it.
std::string extent_text(const Points& points);

/// Particles by number, ascending. Throws bad input, with the line of the setting at `path`, for
/// numbers that none of so many particles has.
std::vector<std::uint32_t> ids_of(const Settings& settings, const std::string& path,
                                  const std::vector<double>& numbers, std::size_t particles);

/// Whether a place (m) at rest is in the box, the ball, in front of the plane and around the axis
/// of a part, as far as it has them; `slack` (m) widens them.
bool is_in_region(const PartSettings& part, const Vec3& place, double slack = 0);

/// Whether a face at rest looks where a part asks for: `area` is its normal, of any length, and
/// `center` (m) a point on it.
bool faces_as(const PartSettings& part, const Vec3& area, const Vec3& center);

class ParticleParts {
 public:
  /// `surface`: of the body, as filled; only what is on it needs one. `component`: of each
  /// particle; only parts by component need them.
  ParticleParts(const Settings& settings, const Body& body, const Triangles& surface,
                std::span<const std::int32_t> component);

  /// The particles in a part, by id, ascending: of a part that faces a direction those next to its
  /// faces. Throws bad input, with the scene's line, for unknown bones, numbers of particles that
  /// do not exist, and a part without particles.
  std::vector<std::uint32_t> particles(const PartSettings& part, const std::string& path) const;

  /// The faces in a part, by their centers, of the surface in triangles of sides up to two radii.
  /// Throws bad input as particles() does.
  Triangles faces(const PartSettings& part, const std::string& path) const;
  /// The same for a pressure, in fewer triangles where no region cuts through them.
  Triangles pressed_faces(const PartSettings& part, const std::string& path) const;

 private:
  class Test;

  const Triangles& fine_surface(const std::string& path) const;

  const Settings& settings_;
  const Body& body_;
  const Triangles& surface_;
  std::span<const std::int32_t> component_;
  mutable Triangles fine_;                      ///< made when it is first asked for
  mutable std::vector<std::uint32_t> nearest_;  ///< particle of each of its faces
};

/// The list `materials` of a scene: gives the particles of each part of a bound body its stiffness,
/// its strength and its number; of parts that overlap the last one counts for what it gives. Throws
/// bad input, with the scene's line, for parts without particles.
void set_local_materials(const Settings& settings, const ParticleParts& parts, Body& body);

}  // namespace sinew

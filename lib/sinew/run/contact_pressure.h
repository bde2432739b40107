// SPDX-License-Identifier: GPL-3.0-or-later
// The pressure with which obstacles and other bodies press on a body's surface. Each part of the
// surface belongs to the particle nearest to it at rest, and each particle presses evenly on what
// belongs to it and faces what presses, as deformed: pressures times areas sum to the forces of the
// contacts, without friction.
//
//     const ContactPressure contacts(surface, body);
//     const SurfaceContact on = contacts.at(moved_points, positions, velocities, obstacles);
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <sinew/body/body.h>
#include <sinew/core/triangles.h>
#include <sinew/world/obstacle.h>

namespace sinew {

/// What presses on the surface, by point.
struct SurfaceContact {
  std::vector<double> pressure;  ///< Pa, 0 without contact
  std::vector<double> area;      ///< area of its part that is in contact, m^2
};

class ContactPressure {
 public:
  /// `surface`: of the body at rest, which must outlive this.
  ContactPressure(const Triangles& surface, const Body& body);

  /// Whether anything may press on it: an obstacle, or one body on another.
  bool any() const;
  /// At one moment. `points`: of the surface, m. `positions` (m) and `velocities` (m/s) of the
  /// particles, by id. `obstacles`: those of the body's world. In parallel; the same bits for any
  /// number of threads.
  SurfaceContact at(const Points& points, const Points& positions, const Points& velocities,
                    std::span<const ObstaclePose> obstacles) const;

 private:
  /// What belongs to a particle of one face: of the face's area, by corner.
  struct Share {
    std::uint32_t face, particle;
    Vec3 corner;
  };

  /// Forces on particles, N: of obstacles, along their normals; of others; the sum, as a vector.
  struct Pressing {
    std::vector<double> force;
    Points others, along;
  };

  void divide(const Triangles& surface);
  Pressing pressing(const Points& positions, const Points& velocities,
                    std::span<const ObstaclePose> obstacles) const;
  std::uint32_t nearest_owner(std::uint32_t particle) const;

  const Body& body_;
  std::vector<std::array<int, 3>> faces_;
  std::vector<Share> shares_;          ///< index: face
  std::vector<char> owns_;             ///< index: particle; whether it has a share
  std::vector<std::int32_t> body_of_;  ///< index: particle; lowest number of what hangs together
};

}  // namespace sinew

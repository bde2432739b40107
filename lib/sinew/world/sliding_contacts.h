// SPDX-License-Identifier: GPL-3.0-or-later
// Dry friction between parts of a body that touch: a spring across each contact of particles, which
// stretches as they slide and turns with them, and a damper beside it. Beyond mu times the force
// that presses them together they slip. (Cundall and Strack, Geotechnique 29, 1979,
// doi 10.1680/geot.1979.29.1.47.)
//
//     SlidingContacts sliding(body);
//     if (sliding.rub(i, j)) touches.push_back({j, ...});
//     force += sliding.force(i, touches, step, true);
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <sinew/body/body.h>
#include <sinew/core/simulation_state.h>
#include <sinew/core/vector.h>

namespace sinew {

/// Another particle that touches one.
struct Touch {
  std::int32_t other = 0;  ///< its id
  Vec3 normal;             ///< unit vector away from it
  double pressing = 0;     ///< N
  Vec3 velocity;           ///< relative to it, m/s
};

class SlidingContacts {
 public:
  SlidingContacts() = default;
  /// None for a material without friction.
  explicit SlidingContacts(const Body& body);

  bool any() const { return !stretched_.empty(); }
  /// Whether particles rub, by id, where they touch: not those that were first or second neighbors
  /// at rest, which make up the material, and not what passes through each other.
  bool rub(std::int32_t a, std::int32_t b) const;

  /// The friction on a particle (N) of all those that touch it, in a step (s). `keep`: the springs
  /// stay as the step leaves them, and those of particles that have parted are gone. Both particles
  /// of a contact find opposite forces. Of different particles at the same time, from any threads.
  Vec3 force(std::int32_t id, std::span<const Touch> touches, double step, bool keep);

  void save(SimulationState& state) const;
  /// Throws bad input for a state of other particles.
  void restore(const SimulationState& state);

 private:
  struct Spring {
    std::int32_t other;
    Vec3 stretch;  ///< m
  };

  Vec3 stretch_of(std::int32_t id, const Touch& touch) const;

  const Body* body_ = nullptr;
  double friction_ = 0, stiffness_ = 0, damping_ = 0;  ///< mu, N/m, kg/s
  double apart_at_rest_ = 0;                           ///< at least, of those that rub, m
  std::vector<std::vector<Spring>> stretched_;         ///< springs by id
};

}  // namespace sinew

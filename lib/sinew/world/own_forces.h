// SPDX-License-Identifier: GPL-3.0-or-later
// Forces that a program of one's own sets between steps.
//
//     OwnForces own(prepared.body.rest.size());
//     prepared.body.world = own.added_to(prepared.body.world);
//     Simulation simulation = start(std::move(prepared));
//     own.set(forces);
#pragma once

#include <cstddef>
#include <memory>

#include <sinew/core/vector.h>
#include <sinew/world/world.h>

namespace sinew {

/// Copies set the same forces.
class OwnForces {
 public:
  /// None on any of so many particles.
  explicit OwnForces(std::size_t particles);

  /// The world (null: an empty one) in which these forces act.
  std::shared_ptr<const World> added_to(const std::shared_ptr<const World>& world) const;

  /// Sets the forces from now on (n x 3, N, by id), between steps. Throws bad input for another
  /// number of them, and for numbers that are not finite.
  void set(Points forces);

 private:
  std::shared_ptr<Points> forces_;
};

}  // namespace sinew

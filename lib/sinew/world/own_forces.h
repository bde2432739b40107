// SPDX-License-Identifier: GPL-3.0-or-later
// Forces that a program of one's own sets between steps.
//
//     OwnForces own(prepared.body.rest.size());
//     prepared.body.world = own.added_to(prepared.body.world);
//     Simulation simulation = start(std::move(prepared));
//     own.set(forces);
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>

#include <sinew/core/error.h>
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
  const Points& now() const { return *forces_; }  ///< n x 3, N, by id

 private:
  std::shared_ptr<Points> forces_;
};

inline OwnForces::OwnForces(std::size_t particles)
    : forces_(std::make_shared<Points>(particles, Vec3::Zero())) {}

inline std::shared_ptr<const World> OwnForces::added_to(
    const std::shared_ptr<const World>& world) const {
  World with = world ? *world : World();
  const auto force = [forces = forces_](const Vec3&, const ParticleInfo& grain) {
    return (*forces)[grain.id];
  };
  with.fields.push_back({"own", CustomForce{force}, {}, {}});
  return std::make_shared<const World>(std::move(with));
}

inline void OwnForces::set(Points forces) {
  if (forces.size() != forces_->size())
    throw bad_input("there are " + std::to_string(forces.size()) + " forces for " +
                        std::to_string(forces_->size()) + " particles",
                    "give one for each");
  if (!std::all_of(forces.begin(), forces.end(), [](const Vec3& f) { return f.allFinite(); }))
    throw bad_input("a force is not finite", "give numbers, in newtons");
  *forces_ = std::move(forces);
}

}  // namespace sinew

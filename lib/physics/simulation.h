// SPDX-License-Identifier: GPL-3.0-or-later
// A body on its moving bones, advanced step by step:
//
//     Simulation simulation(body, motion, particles, solver);
//     while (simulation.time() < end) simulation.step();
//
#pragma once

#include <cstdint>

#include "core/energies.h"
#include "core/particles.h"
#include "core/settings.h"
#include "physics/forces.h"
#include "rig/motion.h"

namespace sinew {

struct Stepping {
  Integrator integrator = Integrator::symplectic_euler;
  double step = 0;              ///< s
  Vec3 gravity = Vec3::Zero();  ///< m/s^2
  Precision precision = Precision::binary64;
  NeighbourSearch neighbour_search = NeighbourSearch::lists;
};

/// What a scene's solver section says of stepping, with the step chosen for it, s.
Stepping stepping_of(const SolverSettings& solver, double step);

class Simulation {
 public:
  /// `particles` in any order, their id telling their place in body.rest.
  Simulation(Body body, Motion motion, Particles particles, const Stepping& stepping);

  /// Advances by one step. Throws Error (unstable) naming step, particle, cause and a cure when a
  /// value is not finite or a particle moves over 0.25 r relative to its bone within the step.
  void step();

  double time() const { return static_cast<double>(steps_) * stepping_.step; }  ///< s
  std::int64_t steps() const { return steps_; }
  const Body& body() const { return body_; }
  const Particles& particles() const { return particles_; }
  Pose pose() const { return pose_at(body_.skeleton, motion_, time()); }

  /// At the present moment; evaluated once, and used by the next step.
  const Forces& forces();
  /// Kinetic energy and dissipation are taken at the moment of the positions, so that the balance
  /// closes to second order in the step.
  Energies energies();

 private:
  void evaluate();
  Vec3 acceleration(std::size_t i) const {
    return forces_.total(i) / particles_.mass + stepping_.gravity;
  }
  /// The velocity at the moment of the positions, between those of the half-steps around it.
  Vec3 centred_velocity(std::size_t i) const;
  void advance(std::size_t i);
  void account();
  bool in_bounds(std::size_t i, const Vec3& before) const;
  [[noreturn]] void fail(std::size_t i) const;

  Body body_;
  Motion motion_;
  Particles particles_;
  Stepping stepping_;
  std::int64_t steps_ = 0;

  Pose pose_;
  Forces forces_;
  bool evaluated_ = false;
  double dissipated_in_step_ = 0;  ///< by the step that begins at the present moment, J
  double power_ = 0;               ///< of the bones at the present moment, W
  double work_ = 0, dissipation_ = 0;
};

}  // namespace sinew

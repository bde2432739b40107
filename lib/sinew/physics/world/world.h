// SPDX-License-Identifier: GPL-3.0-or-later
// All that acts on a body from outside its bones, and its muscles: obstacles, a medium, fields,
// fibers. One thread computes each particle's sums in a fixed order: the bits do not depend on the
// number of threads.
//
//     WorldForces forces;
//     world_forces(particles, world, world_at(world, time, pose), forces);
#pragma once

#include <span>
#include <vector>

#include <sinew/core/particles.h>
#include <sinew/physics/forces.h>
#include <sinew/physics/world/force_field.h>
#include <sinew/physics/world/muscles.h>
#include <sinew/physics/world/obstacle.h>
#include <sinew/physics/world/pins.h>

namespace sinew {

/// What is constant during a run.
struct World {
  std::vector<Obstacle> obstacles;
  Drag drag;
  std::vector<ForceField> fields;
  Muscles muscles;
  std::vector<Pinned> pins;  ///< applied by the stepper; ascending particles
};

/// Whether a body has muscles with fibers.
bool has_muscles(const Body& body);

/// The world at one moment.
struct WorldNow {
  std::vector<ObstaclePose> obstacles;
  std::vector<double> scales;  ///< of the fields
  Activations activations;
};

WorldNow world_at(const World& world, double time, const Pose& pose);

/// Forces in the order of the particles (N), and their contributions to the energy ledger.
struct WorldForces {
  Points contact, drag, field, muscle;
  /// The part of contact and drag that dissipates energy: damping, friction and drag.
  Points losing;
  std::vector<double> power;         ///< of contact and drag at their source's own velocity, W
  std::vector<double> losing_power;  ///< the dissipative part of it, W
  std::vector<Reaction> reactions;   ///< per obstacle, about its frame's origin
  double contact_energy = 0;         ///< stored, J
  FiberEnergy muscle_energy;

  Vec3 total(std::size_t i) const { return contact[i] + drag[i] + field[i] + muscle[i]; }
};

/// All forces of the world on particles at their places and velocities. In parallel.
void world_forces(const Particles& particles, const World& world, const WorldNow& now,
                  WorldForces& forces);

/// What the world does to one particle.
struct ParticleWorld {
  Vec3 force = Vec3::Zero();   ///< of obstacles, drag and fields, N
  Vec3 field = Vec3::Zero();   ///< the part of the fields
  Vec3 losing = Vec3::Zero();  ///< the part that dissipates energy
  double power = 0;            ///< of contact and drag at their source's own velocity, W
  double losing_power = 0;     ///< the dissipative part of it, W
  double contact_energy = 0;   ///< stored, J
};

/// All of it but muscles, dry friction included: see world_forces() and stop_sliding(). `others`:
/// all other forces on it, N, the weight included. Adds to the obstacles' reactions.
ParticleWorld world_on(const HeldParticle& particle, double mass, const World& world,
                       const WorldNow& now, const Vec3& others, double step,
                       std::span<Reaction> reactions);

/// Adds the dry friction of obstacles without `stick`, given all other forces on each particle (n,
/// in the order of the particles, N; including those of the world) and the step (s): a particle
/// that slides stops at the step's end, or is subject to mu f_n where that is less. Of several
/// obstacles each acts on what the ones before it leave. In parallel.
void stop_sliding(const Particles& particles, const World& world, const WorldNow& now,
                  const Points& others, double step, WorldForces& forces);

/// Powers put in and lost, W.
struct WorldPowers {
  double obstacles = 0;  ///< put in by obstacles that move, and by the medium
  double fields = 0;     ///< put in
  double muscles = 0;    ///< put in: force times velocity
  double lost = 0;       ///< to drag, friction and contact damping
};

/// Powers of `forces` while the particles move at `velocities` (n x 3, m/s, in the order of the
/// particles; a ledger passes those of mid-step, which differ from those of the forces). Kinetic
/// and contact energy grow by obstacles + fields + muscles - lost. If muscle_energy.stored counts
/// as energy of the body, muscle_energy.power replaces muscles.
WorldPowers world_powers(const WorldForces& forces, const Points& velocities);

/// An upper bound of the stiffness that the world adds to a particle of `particles`' radius and
/// mass, N/m: the three stiffest obstacles (more at once need a shorter step), fields and muscles.
double added_stiffness(const World& world, const Particles& particles);

/// An upper bound of the damping rate it adds, 1/s: drag, and the larger of damping and stick of
/// the three strongest obstacles.
double added_damping(const World& world, const Particles& particles);

/// Throws bad input, which names what is wrong, for invalid obstacles, fields or drag.
/// make_muscles() checks muscles.
void check_world(const World& world);

}  // namespace sinew

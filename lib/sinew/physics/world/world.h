// SPDX-License-Identifier: GPL-3.0-or-later
// All that acts on a body from outside its bones, and its muscles: obstacles, a medium, fields,
// fibres. Each particle's sums are made by one thread in a fixed order: the bits do not depend on
// the number of threads.
#pragma once

#include <vector>

#include <sinew/core/particles.h>
#include <sinew/physics/forces.h>
#include <sinew/physics/world/force_field.h>
#include <sinew/physics/world/muscles.h>
#include <sinew/physics/world/obstacle.h>
#include <sinew/physics/world/pins.h>

namespace sinew {

/// What stays the same during a run.
struct World {
  std::vector<Obstacle> obstacles;
  Drag drag;
  std::vector<ForceField> fields;
  Muscles muscles;
  std::vector<Pinned> pins;  ///< held by whoever steps, ascending particles
};

/// The world at one moment.
struct WorldNow {
  std::vector<ObstaclePose> obstacles;
  std::vector<double> scales;  ///< of the fields
  Activations activations;
};

WorldNow world_at(const World& world, double time, const Pose& pose);

/// Forces in the order of the particles (N), with what a ledger of the energy needs.
struct WorldForces {
  Points contact, drag, field, muscle;
  /// The part of contact and drag that loses energy: damping, friction and drag.
  Points losing;
  std::vector<double> power;         ///< of contact and drag at their source's own velocity, W
  std::vector<double> losing_power;  ///< losing's part of it, W
  std::vector<Reaction> reactions;   ///< per obstacle, about its frame's origin
  double contact_energy = 0;         ///< stored, J
  FibreEnergy muscle_energy;

  Vec3 total(std::size_t i) const { return contact[i] + drag[i] + field[i] + muscle[i]; }
};

/// All forces of the world on particles at their places and velocities. In parallel.
void world_forces(const Particles& particles, const World& world, const WorldNow& now,
                  WorldForces& forces);

/// Adds the dry friction of obstacles without `stick`, given all other forces on each particle (n,
/// in the order of the particles, N; those of the world as well) and the step (s) they will be used
/// for: a particle that slides stops at the step's end, or feels mu f_n where that is less. Between
/// several obstacles each acts on what the ones before it leave. In parallel.
void stop_sliding(const Particles& particles, const World& world, const WorldNow& now,
                  const Points& others, double step, WorldForces& forces);

/// What is put in and lost, W.
struct WorldPowers {
  double obstacles = 0;  ///< put in by obstacles that move, and by the medium
  double fields = 0;     ///< put in
  double muscles = 0;    ///< put in: force times velocity
  double lost = 0;       ///< to drag, friction and contact damping
};

/// Powers of `forces` while the particles move at `velocities` (n x 3, m/s, in the order of the
/// particles; a ledger passes those of mid-step, which differ from those the forces had). Kinetic
/// and contact energy grow by obstacles + fields + muscles - lost. Who counts muscle_energy.stored
/// as energy of the body counts muscle_energy.power instead of muscles.
WorldPowers world_powers(const WorldForces& forces, const Points& velocities);

/// A bound on the stiffness that the world adds to a particle of `particles`' radius and mass, N/m:
/// the three stiffest obstacles (more at once need a shorter step), fields and muscles.
double added_stiffness(const World& world, const Particles& particles);

/// A bound on the damping rate it adds, 1/s: drag, and the larger of damping and stick of the three
/// obstacles that brake most.
double added_damping(const World& world, const Particles& particles);

/// Throws bad input, naming what is wrong, for obstacles, fields or a drag that are. Muscles are
/// checked by make_muscles.
void check_world(const World& world);

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// All that acts on a body from outside its bones, and its muscles: obstacles, a medium, fields,
// fibers, supports and loads.
//
//     const WorldNow now = world_at(world, time, pose);
//     const ParticleWorld on = world_on(particle, mass, world, now, others, step, reactions);
#pragma once

#include <span>
#include <vector>

#include <sinew/body/body.h>
#include <sinew/body/forces.h>
#include <sinew/core/particles.h>
#include <sinew/world/force_field.h>
#include <sinew/world/loads.h>
#include <sinew/world/muscles.h>
#include <sinew/world/obstacle.h>
#include <sinew/world/pins.h>
#include <sinew/world/supports.h>

namespace sinew {

/// What is constant during a run.
struct World {
  std::vector<Obstacle> obstacles;
  Drag drag;
  std::vector<ForceField> fields;
  Muscles muscles;
  std::vector<Pinned> pins;            ///< applied by the stepper; ascending particles
  std::vector<Support> supports = {};  ///< their particles are among the pins: see hold()
  std::vector<Load> loads = {};
};

/// Whether a body has muscles with fibers.
bool has_muscles(const Body& body);

/// The world at one moment.
struct WorldNow {
  std::vector<ObstaclePose> obstacles;
  std::vector<double> scales;  ///< scales of the fields
  Activations activations;
  std::vector<ObstaclePose> supports;
  std::vector<LoadAt> loads;
};

WorldNow world_at(const World& world, double time, const Pose& pose);

/// Where pins and supports hold a particle that was at `rest` (m), with the bones at `pose`.
PinPose held_place(const Pinned& held, const Vec3& rest, const World& world,
                   std::span<const ObstaclePose> supports, const Skeleton& skeleton,
                   const Pose& pose);

/// The force of the body on each bone through the obstacles that ride on it, about its head; `on`:
/// on each obstacle, about its frame. None where no obstacle rides on a bone.
std::vector<Reaction> reactions_through_obstacles(const World& world,
                                                  const std::vector<Reaction>& on, double time,
                                                  const Pose& pose);

/// What the world does to one particle, but for muscles; N, W and J.
struct ParticleWorld {
  Vec3 contact = Vec3::Zero(), drag = Vec3::Zero(), field = Vec3::Zero();
  Vec3 losing = Vec3::Zero();  ///< the part that dissipates energy: damping, friction and drag
  double power = 0;            ///< power of contact and drag at their source's own velocity
  double losing_power = 0;     ///< the dissipative part of it
  double contact_energy = 0;   ///< stored

  Vec3 force() const { return contact + drag + field; }
};

/// The world's forces on a particle of `mass` (kg), and the obstacles' reactions, which are added
/// to. `others` (N): all other forces on it, the weight included. Obstacles without `stick` answer
/// them with dry friction: a particle that slides stops at the end of the step (s), or is subject
/// to mu f_n where that is less; of several obstacles each acts on what the ones before it leave.
/// No such friction with a step of 0.
ParticleWorld world_on(const ParticleState& particle, double mass, const World& world,
                       const WorldNow& now, const Vec3& others, double step,
                       std::span<Reaction> reactions);

/// An upper bound of the stiffness that the world adds to a particle of `particles`' radius and
/// mass, N/m: three stiffest obstacles (more need a shorter step), fields, muscles, pressures.
double added_stiffness(const World& world, const Particles& particles);

/// An upper bound of the damping rate it adds, 1/s: drag, and the larger of damping and stick of
/// the three strongest obstacles.
double added_damping(const World& world, const Particles& particles);

/// Throws bad input, which names what is wrong, for invalid obstacles, fields, loads or drag.
/// make_muscles() checks muscles.
void check_world(const World& world);

}  // namespace sinew

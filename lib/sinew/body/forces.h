// SPDX-License-Identifier: GPL-3.0-or-later
// All forces on all particles at one moment: pairs (eq. 1), damping (eq. 2), bones. One thread
// computes each particle's sums in a fixed order: the bits do not depend on the number of threads.
//
//     Forces forces;
//     pair_forces(particles, body.material, forces);
//     bone_forces(particles, body, pose, forces);
#pragma once

#include <cstdint>
#include <vector>

#include <sinew/body/body.h>
#include <sinew/core/particles.h>
#include <sinew/rig/pose.h>

namespace sinew {

/// Forces in the order of the particles, N.
struct Forces {
  Points pair, damping, bone;
  Points world;                ///< obstacles, drag, fields, muscles; empty without a world
  Points group;                ///< what keeps groups of particles together; empty without them
  std::vector<int> neighbors;  ///< neighbors closer than b

  // Filled by bone_forces() only; a simulation's own forces leave them empty.
  Points bone_damping;                     ///< the damping's part of `bone`
  std::vector<double> bone_power;          ///< power from the bones, W
  std::vector<double> bone_damping_power;  ///< the damping's part of it, W

  Vec3 total(std::size_t i) const {
    Vec3 sum = pair[i] + damping[i] + bone[i];
    if (!world.empty()) sum += world[i];
    if (!group.empty()) sum += group[i];
    return sum;
  }
};

/// Pair forces and damping, found with the paper's cells. Fills pair, damping and neighbors.
void pair_forces(const Particles& particles, const Material& material, Forces& forces);
/// The same between particles of a body that do not pass through each other.
void pair_forces(const Particles& particles, const Body& body, Forces& forces);

/// Bone forces at `pose`. Fills bone, bone_damping and the powers.
void bone_forces(const Particles& particles, const Body& body, const Pose& pose, Forces& forces);

/// Force and moment about its head that the body puts on a bone; of a support or a load: that it
/// puts on the body, about its pivot.
struct Reaction {
  Vec3 force = Vec3::Zero();   ///< N
  Vec3 moment = Vec3::Zero();  ///< N m
  double power = 0;            ///< power from the bone, support or load into the body, W

  Reaction& operator+=(const Reaction& other) {
    force += other.force;
    moment += other.moment;
    power += other.power;
    return *this;
  }
};

/// What the body puts on each bone by all that holds it there.
struct BoneReactions {
  std::vector<Reaction> springs;
  std::vector<Reaction> pins;       ///< pins on the bone; the inertia of pinned particles apart
  std::vector<Reaction> obstacles;  ///< obstacles that ride on it

  std::vector<Reaction> sums() const;
};

/// Per bone: F = -sum f, M = -sum (x - head) x f; the power of a rigid bone is -(F.o' + M.omega).
/// `pulls`: the force of all its bones on each particle (n x 3, N).
std::vector<Reaction> reactions(const Particles& particles, const Points& pulls, const Body& body,
                                const Pose& pose);

/// Force (N) and moment about the center of mass (N m) of all that acts on the body from outside:
/// bones, the world, its weight. By Newton's law the rate of change of its momentum.
Reaction resultant(const Particles& particles, const Forces& forces, const Body& body,
                   const Vec3& gravity);

/// Stored energies, J.
double pair_energy(const Particles& particles, const PairForce& pair);
double pair_energy(const Particles& particles, const Body& body);
double bone_energy(const Particles& particles, const Body& body, const Pose& pose);

}  // namespace sinew

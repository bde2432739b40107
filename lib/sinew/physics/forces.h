// SPDX-License-Identifier: GPL-3.0-or-later
// All forces on all particles at one moment: pairs (eq. 1), damping (eq. 2), bones. One thread
// computes each particle's sums in a fixed order: the bits do not depend on the number of threads.
//
//     Forces forces;
//     pair_forces(particles, body.material, forces);
//     bone_forces(particles, body, pose, forces);
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <sinew/core/particles.h>
#include <sinew/physics/bond_factors.h>
#include <sinew/physics/bone_force.h>
#include <sinew/physics/local_strength.h>
#include <sinew/physics/material.h>
#include <sinew/rig/binding.h>
#include <sinew/rig/pose.h>

namespace sinew {

struct World;
struct Grouping;

/// Forces in the order of the particles, N.
struct Forces {
  Points pair, damping, bone;
  Points world;                ///< obstacles, drag, fields, muscles; empty without a world
  Points group;                ///< what keeps groups of particles together; empty without them
  std::vector<int> neighbors;  ///< neighbors closer than b

  // Filled by bone_forces() only; a simulation's own forces leave them empty.
  Points bone_damping;                     ///< the damping's part of `bone`
  std::vector<double> bone_power;          ///< from the bones, W
  std::vector<double> bone_damping_power;  ///< the damping's part of it, W

  Vec3 total(std::size_t i) const {
    Vec3 sum = pair[i] + damping[i] + bone[i];
    if (!world.empty()) sum += world[i];
    if (!group.empty()) sum += group[i];
    return sum;
  }
};

/// A body, its material and its binding: all that is constant during a run.
struct Body {
  Points rest;  ///< positions at rest by particle id, m
  Skeleton skeleton;
  Binding binding;  ///< by particle id
  Material material;
  std::vector<BoneSprings> springs;  ///< per bone
  Mat3 lattice = Mat3::Identity();   ///< columns: the packing's axes
  /// Volume of the body around each particle, by id, over that of one inside; empty: 1 each.
  std::vector<double> share = {};
  std::vector<double> stiffness = {};  ///< of the material there over `material`'s; empty: 1 each
  std::vector<double> density = {};    ///< the same of the density
  /// Of each particle, its place in the scene's list of materials, from 1, or 0; empty: 0 each.
  std::vector<std::int32_t> material_number = {};
  LocalStrength local = {};  ///< of the materials of its parts
  BondFactors factors = {};  ///< on the stiffness of bonds, by `stiffness` and near the surface
  std::shared_ptr<const World> world = {};        ///< none: nothing surrounds it
  std::shared_ptr<const Grouping> grouping = {};  ///< none: all particles are free
};

/// Of one of its particles, by id, kg; `common`: of one with the material's density.
inline double mass_of(const Body& body, std::size_t id, double common) {
  return body.density.empty() ? common : common * body.density[id];
}
/// Of all of them.
double total_mass(const Body& body, double common);
/// The material with the mass of the lightest particle.
Material lightest(const Body& body);

/// Whether any of its particles keeps its volume.
inline bool keeps_volume(const Body& body) {
  return largest_of(body.local.volume, body.material.volume_stiffness) > 0;
}

/// Pair forces and damping, found with the paper's cells. Fills pair, damping and neighbors.
void pair_forces(const Particles& particles, const Material& material, Forces& forces);

/// Bone forces at `pose`. Fills bone, bone_damping and the powers.
void bone_forces(const Particles& particles, const Body& body, const Pose& pose, Forces& forces);

/// Force and moment about its head that the body puts on a bone; of a support or a load: that it
/// puts on the body, about its pivot.
struct Reaction {
  Vec3 force = Vec3::Zero();   ///< N
  Vec3 moment = Vec3::Zero();  ///< N m
  double power = 0;            ///< from the bone, support or load into the body, W

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
  std::vector<Reaction> pins;       ///< that are on the bone; the inertia of pinned particles apart
  std::vector<Reaction> obstacles;  ///< that ride on it

  std::vector<Reaction> sums() const;
};

/// Per bone: F = -sum f, M = -sum (x - head) x f; the power of a rigid bone is -(F.o' + M.omega).
/// `pulls`: the force of all its bones on each particle (n x 3, N).
std::vector<Reaction> reactions(const Particles& particles, const Points& pulls, const Body& body,
                                const Pose& pose);

/// Stored energies, J.
double pair_energy(const Particles& particles, const PairForce& pair);
double bone_energy(const Particles& particles, const Body& body, const Pose& pose);

}  // namespace sinew

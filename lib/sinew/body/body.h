// SPDX-License-Identifier: GPL-3.0-or-later
// A body, its material and its binding: all that is constant during a run.
//
//     const Body body = make_body(settings, files, skeleton, particles);
//     const double mass = mass_of(body, id, particles.mass);
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <sinew/body/bond_factors.h>
#include <sinew/body/bone_force.h>
#include <sinew/body/pass_through.h>
#include <sinew/body/rigid_damping.h>
#include <sinew/core/hash.h>
#include <sinew/core/particles.h>
#include <sinew/core/rest_neighbors.h>
#include <sinew/material/local_strength.h>
#include <sinew/material/material.h>
#include <sinew/rig/binding.h>

namespace sinew {

struct World;
struct Grouping;

/// A body, its material and its binding: all that is constant during a run.
struct Body {
  Points rest;  ///< positions at rest by particle id, m
  Skeleton skeleton;
  Binding binding;  ///< bonds to bones by particle id
  Material material;
  std::vector<BoneSprings> springs;  ///< per bone
  Mat3 lattice = Mat3::Identity();   ///< columns: the packing's axes
  /// Volume of the body around each particle, by id, over that of one inside; empty: 1 each.
  std::vector<double> volume_share = {};
  std::vector<double> stiffness = {};  ///< modulus of the material there over `material`; empty: 1
  std::vector<double> density = {};    ///< density likewise
  /// Place of each particle's material in the scene's list, from 1, or 0; empty: 0 each.
  std::vector<std::int32_t> material_number = {};
  LocalStrength local = {};       ///< strengths of the materials of its parts
  PassThrough pass_through = {};  ///< bones whose flesh exerts no contact on each other
  BondFactors factors = {};  ///< on the stiffness of bonds, by `stiffness` and near the surface
  /// Neighbors at rest, which whoever makes a body may leave with it; none: not there, or released
  /// before stepping, which needs them no more.
  SharedNeighbors neighbors = {};
  std::shared_ptr<const World> world = {};                 ///< none: nothing surrounds it
  std::shared_ptr<const Grouping> grouping = {};           ///< none: all particles are free
  std::shared_ptr<const RigidDamping> rigid_damping = {};  ///< none: there is none
};

/// Particles nearer than this at rest, m, act on each other whatever bones hold them.
double near_at_rest(const Material& material);
/// Whether particles, by id, pass through each other; the same for both orders.
bool pass_through(const Body& body, std::size_t a, std::size_t b);

/// The neighbors that a body has, or else those of a search.
SharedNeighbors neighbors_of(const Body& body);

/// Returns the mass of particle `id`, kg; `common`: that of one with the material's density.
inline double mass_of(const Body& body, std::size_t id, double common) {
  return body.density.empty() ? common : common * body.density[id];
}
/// Returns the mass of all of them.
double total_mass(const Body& body, double common);
/// The material with the mass of the lightest particle.
Material lightest(const Body& body);

/// What runs go on by: the particles at rest, what binds them, and whose material is whose.
Hash hash_at_rest(const Body& body);
/// The same with the size of the particles and the bones at rest.
Hash hash_of(const Body& body);

/// Whether any of its particles keeps its volume.
inline bool keeps_volume(const Body& body) {
  return largest_of(body.local.volume, body.material.volume_stiffness) > 0;
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// Pair forces of solids, which keep their shape; the paper's body flows.
//
// bonded: neighbors at rest are bonds, f = -k (d - l) e; all other pairs repel by eq. 1. Second
// neighbors have bonds as well, a quarter as stiff, with which a body is isotropic, and repel by
// eq. 1 too; bond_factors.h keeps surfaces from being softer.
// bonded_volume: in addition, each particle keeps its volume, U_i = (K_v / 2) V0 w_i (J_i - 1)^2
// with J_i of the least-squares deformation gradient F_i over its neighbors at rest, F_i = sum dx
// dX^T A_i^-1, A_i = sum dX dX^T. That conserves momentum and angular momentum. The weights w_i
// (volume_weights.h) are small where neighbors are few, and larger than 1 next to them.
// Bonds that yield creep without a change of volume (as von Mises' plasticity). T = sum (p - m w) n
// n^T / sum w is a particle's stress without pressure: the sum is over its bonds, n are their
// directions, p = k (d - l) d, w = k l0^2 with the length l0 before any flow, m = sum p / sum w.
// Where sum w nnnn is isotropic, D = 15/2 dev T is the deviator of a small elastic strain, and at
// any strain that of the stress over 2 G. Where the shear sqrt(D : D) exceeds the yield shear y,
// the rest length of a bond between i and j changes by
//   dl/dt = rate l n (P_i + P_j)/2 n,  P = (1 - y / sqrt(D : D)) D, or 0 below it:
// shear decays to the yield shear, and pressure stays.
// Bonds that relax have branches: see maxwell.h.
// paper with cohesion initial_neighbors: eq. 1, but only neighbors at rest attract each other.
//
//     Solid solid(material, rest);
//     solid.forces(particles, forces);
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include <sinew/body/bond_factors.h>
#include <sinew/body/forces.h>
#include <sinew/core/cell_grid.h>
#include <sinew/core/particles.h>
#include <sinew/material/laws.h>
#include <sinew/material/local_strength.h>
#include <sinew/material/material.h>
#include <sinew/material/maxwell.h>

namespace sinew {

// The bonds of a solid: neighbors at rest stay bonded wherever they move. A bond is a spring;
// beyond a strain it breaks, and where shear is large its rest length creeps (plastic flow).

struct Bonds {
  NeighborLists neighbors;           ///< in both directions, in the order of the particles
  std::vector<double> rest_length;   ///< one per entry of neighbors, m; 0 once broken
  std::vector<double> stiffness;     ///< one per entry, N/m
  std::vector<std::int32_t> broken;  ///< number of broken bonds of each particle

  std::size_t size() const { return neighbors.neighbor.size() / 2; }
  bool whole(std::size_t entry) const { return rest_length[entry] > 0; }
  /// Whether an unbroken bond connects them.
  bool bonded(std::size_t i, std::uint32_t j) const;
};

/// The nearest and the second neighbors of each particle at rest, by place. A pair of second
/// neighbors also repels in contact, and is not damped before: only its spring is a bond.
struct SolidBonds {
  Bonds nearest, second;
};

/// Between all particles at `rest` (m) that are neighbors there (RestNeighbors::all), both in the
/// order of the particles.
/// `id` and `factors` of the particles; none: the material's stiffness throughout.
SolidBonds make_bonds(const Points& rest, const NeighborLists& near, const Material& material,
                      std::span<const std::int32_t> id = {}, const BondFactors& factors = {});

/// A bond seen from one of its particles.
struct BondNow {
  std::uint32_t neighbor;
  Vec3 offset;  ///< vector from it, m
  double distance;
  BondSpring spring;
  std::uint32_t entry;
};

/// Calls visit(BondNow) for the unbroken bonds of particle i.
template <class Visit>
void for_each_bond(const Bonds& bonds, const Particles& particles, std::size_t i, Visit&& visit) {
  for (std::uint32_t e = bonds.neighbors.first[i]; e < bonds.neighbors.first[i + 1]; ++e) {
    if (!bonds.whole(e)) continue;
    const std::uint32_t j = bonds.neighbors.neighbor[e];
    const Vec3 offset = particles.position(i) - particles.position(j);
    visit(BondNow{j, offset, offset.norm(), {bonds.rest_length[e], bonds.stiffness[e]}, e});
  }
}

/// The present rest lengths of a body's bonds, by particle id, as a stepper with lists of its own
/// gives them.
class BondRest {
 public:
  /// Neighbors at rest by id, ascending: the nearest ones and the second ones (none: empty).
  BondRest(const NeighborLists& nearest, const NeighborLists& second);

  /// Sets the length of one direction of a whole bond, m. What is never set is broken.
  void set(std::int32_t i, std::int32_t j, bool nearest, double length);
  /// Takes the lengths of the nearest ones, by entry, then of the second ones, m; 0 once broken.
  std::vector<double> take() { return std::move(length_); }

 private:
  const NeighborLists& nearest_;
  const NeighborLists& second_;
  std::vector<double> length_;
};

/// Whether a material's forces depend on the neighbors at rest.
bool remembers_neighbors(const Material& material);

class Solid {
 public:
  /// Whether particles, by their place in the order, pass through each other; empty: none do.
  using Passing = std::function<bool(std::size_t, std::size_t)>;

  /// `rest` in the order of the particles, m; `id` and `factors` as in make_bonds(); `local` by id.
  Solid(const Material& material, Points rest, std::span<const std::int32_t> id = {},
        const BondFactors& factors = {}, const LocalStrength& local = {}, Passing passing = {});

  /// Returns the branches of its bonds: what follows is of the step that began there last.
  MaxwellBranches& branches() { return branches_; }
  const MaxwellBranches& branches() const { return branches_; }

  /// Pair forces, and eq. 2 between partners: particles that are bonded (in the paper's model,
  /// neighbors at rest closer than b) or touch. Bodies that do not touch must not drag each other.
  /// Fills pair, damping and neighbors.
  void forces(const Particles& particles, Forces& forces);
  /// Stored in bonds, contacts and volumes, J.
  double energy(const Particles& particles);
  /// Creep and fracture over a step (s), at the positions of the last call of forces(). Returns the
  /// energy lost, J.
  double evolve(const Particles& particles, double step);

  const SolidBonds& bonds() const { return bonds_; }
  std::int32_t broken(std::size_t i) const {
    return bonds_.nearest.broken[i] + bonds_.second.broken[i];
  }
  /// Rest lengths of all bonds, the second neighbors' last, and back again, with what is broken.
  /// Throws bad input where they are not this solid's.
  std::vector<double> rest_lengths() const;
  void restore(const std::vector<double>& rest_length);
  /// Returns the length (m) at which a whole entry of bonds().nearest or .second pulls nothing as
  /// long as its branches stay.
  double free_length(bool nearest, std::uint32_t entry) const;

 private:
  template <class Visit>
  void for_each_bonded(const Particles& particles, std::size_t i, const Visit& visit) const;
  template <class Visit>
  void for_each_touched(const Particles& particles, const CellGrid& cells, std::size_t i,
                        const Visit& visit) const;
  void add_springs_of_second(const Particles& particles, Forces& forces) const;
  void find_volumes(const Particles& particles);
  Vec3 volume_force(std::size_t i) const;
  std::vector<Mat3> flow(const Particles& particles) const;
  double evolve(Bonds& bonds, Branches& branches, bool repels_then, const std::vector<Mat3>& flow,
                const Particles& particles, double step) const;
  double volume_energy(std::size_t i) const;
  double breaking_strain(std::size_t i, std::size_t j) const;

  Material material_;
  const ForceLaw* law_;
  Passing pass_;
  Points rest_;
  SolidBonds bonds_;
  MaxwellBranches branches_;
  LocalStrength local_;         ///< one per particle; volume: empty where none is kept
  std::vector<Mat3> inverse_;   ///< inverses of A_i, 1/m^2; only where volumes are kept
  std::vector<double> weight_;  ///< w_i
  std::vector<double> volume_;  ///< J_i - 1 at the positions of the last call of forces()
  std::vector<Mat3> thrust_;    ///< K_v V0 w_i (J_i - 1) cof(F_i) A_i^-1, N/m
};

}  // namespace sinew

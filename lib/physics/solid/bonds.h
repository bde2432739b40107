// SPDX-License-Identifier: GPL-3.0-or-later
// The bonds of a solid: what were neighbours at rest stay partners wherever they go. A bond is a
// spring from its rest length; beyond a strain it breaks, and beyond another one its rest length
// creeps after it (plastic flow).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/neighbours.h"
#include "core/particles.h"
#include "physics/material.h"

namespace sinew {

struct Bonds {
  NeighbourLists partners;           ///< from both sides, in the order of the particles
  std::vector<double> rest_length;   ///< by entry of partners, m; 0 once broken
  std::vector<std::int32_t> broken;  ///< by particle

  std::size_t size() const { return partners.partner.size() / 2; }
  bool whole(std::size_t entry) const { return rest_length[entry] > 0; }
  /// Whether i and j were neighbours at rest.
  bool were_neighbours(std::size_t i, std::uint32_t j) const;
  /// Whether a bond holds them together.
  bool bonded(std::size_t i, std::uint32_t j) const;
};

/// Between all particles of radius `r` (m) that are neighbours at `rest` (m).
Bonds make_bonds(const Points& rest, double r);

/// Calls visit(j, offset, d, rest length) for the whole bonds of particle i: x_i - x_j, its length.
template <class Visit>
void for_each_bond(const Bonds& bonds, const Particles& particles, std::size_t i, Visit&& visit) {
  for (std::uint32_t e = bonds.partners.first[i]; e < bonds.partners.first[i + 1]; ++e) {
    if (!bonds.whole(e)) continue;
    const std::uint32_t j = bonds.partners.partner[e];
    const Vec3 offset = particles.position(i) - particles.position(j);
    visit(j, offset, offset.norm(), bonds.rest_length[e]);
  }
}

/// Lets bonds creep and break over a time (s). A broken pair repels in contact as any other.
/// Returns the energy that is lost, J.
double evolve(Bonds& bonds, const BondStrength& strength, const PairForce& contact,
              const Particles& particles, double time);

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/solid/bonds.h"

#include <algorithm>
#include <cmath>

#include "core/closest_packing.h"
#include "physics/partners.h"

namespace sinew {
namespace {

constexpr std::uint32_t none = 0xffffffff;

/// Where j stands among the partners of i.
std::uint32_t entry_of(const Bonds& bonds, std::size_t i, std::uint32_t j) {
  const auto begin = bonds.partners.partner.begin();
  const auto last = begin + bonds.partners.first[i + 1];
  const auto found = std::lower_bound(begin + bonds.partners.first[i], last, j);
  return found != last && *found == j ? static_cast<std::uint32_t>(found - begin) : none;
}

/// The rest length after a time: what exceeds the yield strain decays; 0 for a bond that breaks.
double next_length(const BondStrength& strength, double length, double d, double time) {
  if (strength.breaking_strain > 0 && d > length * (1 + strength.breaking_strain)) return 0;
  if (strength.yield_strain <= 0) return length;
  const double excess = std::abs(d - length) - strength.yield_strain * length;
  if (excess <= 0) return length;
  const double crept = excess * -std::expm1(-strength.creep_rate * time);
  return length + (d > length ? crept : -crept);
}

double energy(const BondStrength& strength, const PairForce& contact, double length, double d) {
  if (length > 0) return strength.stiffness / 2 * (d - length) * (d - length);
  return d < 2 * contact.r ? contact.potential(d) - contact.potential(2 * contact.r) : 0;
}

}  // namespace

bool Bonds::were_neighbours(std::size_t i, std::uint32_t j) const {
  return entry_of(*this, i, j) != none;
}

bool Bonds::bonded(std::size_t i, std::uint32_t j) const {
  const std::uint32_t entry = entry_of(*this, i, j);
  return entry != none && whole(entry);
}

Bonds make_bonds(const Points& rest, double r) {
  Bonds bonds;
  bonds.partners = neighbours_within(rest, rest_neighbour_range(r));
  bonds.rest_length.resize(bonds.partners.partner.size());
  bonds.broken.assign(rest.size(), 0);
  for_each_particle(rest.size(), [&](std::size_t i) {
    for (std::uint32_t e = bonds.partners.first[i]; e < bonds.partners.first[i + 1]; ++e)
      bonds.rest_length[e] = (rest[i] - rest[bonds.partners.partner[e]]).norm();
  });
  return bonds;
}

double evolve(Bonds& bonds, const BondStrength& strength, const PairForce& contact,
              const Particles& particles, double time) {
  if (strength.breaking_strain <= 0 && strength.yield_strain <= 0) return 0;
  // Both sides of a bond see the same distance to the last bit, and do the same with it.
  return sum_over_particles(particles.size(), [&](std::size_t i) {
    double released = 0;
    for (std::uint32_t e = bonds.partners.first[i]; e < bonds.partners.first[i + 1]; ++e) {
      if (!bonds.whole(e)) continue;
      const double d =
          (particles.position(i) - particles.position(bonds.partners.partner[e])).norm();
      const double before = bonds.rest_length[e];
      const double after = next_length(strength, before, d, time);
      bonds.rest_length[e] = after;
      bonds.broken[i] += after == 0;
      released += (energy(strength, contact, before, d) - energy(strength, contact, after, d)) / 2;
    }
    return released;
  });
}

}  // namespace sinew

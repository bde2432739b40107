// SPDX-License-Identifier: GPL-3.0-or-later
// One pass over all pairs: their forces, the neighbor counts, and the damping of eq. 2.
//
//     pair_pass(particles, material, for_each_partner, forces);
#pragma once

#include <cmath>

#include <sinew/body/forces.h>
#include <sinew/core/cell_grid.h>
#include <sinew/core/parallel.h>
#include <sinew/core/particles.h>

namespace sinew {

// The neighbors of a particle, found with the paper's cells: its own and the adjacent ones.

inline constexpr std::size_t particles_per_walk = 256;

inline CellGrid cells_of(const Particles& particles, double range) {
  return {particles.x, particles.y, particles.z, range};
}

/// Points from j to i. Two coincident particles separate along x, the lower id to the left.
inline Vec3 direction_from(const Particles& particles, const Vec3& offset, double d, std::size_t i,
                           std::size_t j) {
  return d > 0 ? Vec3(offset / d) : Vec3(particles.id[i] < particles.id[j] ? -1 : 1, 0, 0);
}

/// Calls visit(j, offset, d) for every neighbor j of particle i: x_i - x_j and its length d < b.
template <class Visit>
void for_each_neighbor(const Particles& particles, const CellGrid& cells, double b, std::size_t i,
                       Visit&& visit) {
  const Vec3 here = particles.position(i);
  cells.for_each_near(here, [&](std::uint32_t j) {
    if (j == i) return;
    const Vec3 offset = here - particles.position(j);
    const double squared = offset.squaredNorm();
    if (squared < b * b) visit(j, offset, std::sqrt(squared));
  });
}

/// Calls visit(i) for all particles, in parallel.
template <class Visit>
void for_each_particle(std::size_t particles, Visit&& visit) {
  parallel_for(particles, particles_per_walk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) visit(i);
  });
}

/// The sum of value(i) over all particles, the same for any number of threads.
template <class Value>
double sum_over_particles(std::size_t particles, Value&& value) {
  return parallel_sum(particles, particles_per_walk, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += value(i);
    return sum;
  });
}

/// Pairwise damping with the mean of both counts, which must be known: conserves momentum, and with
/// only the part along the pair (central) angular momentum as well.
template <class ForEachPartner>
void pairwise_damping(const Particles& particles, const Material& material,
                      const ForEachPartner& for_each_partner, Forces& forces) {
  const bool central = acts_along_pairs(material.damping_form);
  for_each_particle(particles.size(), [&](std::size_t i) {
    Vec3 sum = Vec3::Zero();
    for_each_partner(i, [&](std::uint32_t j, const Vec3& offset, double d, double) {
      const double weight = (1.0 / forces.neighbors[i] + 1.0 / forces.neighbors[j]) / 2;
      const Vec3 approach = particles.velocity(i) - particles.velocity(j);
      const Vec3 along = direction_from(particles, offset, d, i, j);
      sum += weight * (central ? Vec3(approach.dot(along) * along) : approach);
    });
    forces.damping[i] = -material.damping * sum;
  });
}

/// for_each_partner(i, visit) calls visit(j, offset, d, force) for every particle j that acts on i:
/// x_i - x_j, its length (m), and the force along it (N; positive repels). Damping acts between
/// partners, whose number is the particle's count of neighbors. Fills pair, damping and neighbors.
template <class ForEachPartner>
void pair_pass(const Particles& particles, const Material& material,
               const ForEachPartner& for_each_partner, Forces& forces) {
  forces.pair.resize(particles.size());
  forces.damping.resize(particles.size());
  forces.neighbors.resize(particles.size());
  for_each_particle(particles.size(), [&](std::size_t i) {
    Vec3 force = Vec3::Zero(), velocities = Vec3::Zero();
    int count = 0;
    for_each_partner(i, [&](std::uint32_t j, const Vec3& offset, double d, double push) {
      force += push * direction_from(particles, offset, d, i, j);
      velocities += particles.velocity(j);
      ++count;
    });
    forces.pair[i] = force;
    forces.neighbors[i] = count;
    forces.damping[i] = Vec3::Zero();
    if (count > 0 && material.damping > 0)  // towards the partners' mean velocity
      forces.damping[i] = -material.damping * (particles.velocity(i) - velocities / count);
  });
  if (material.damping_form != DampingForm::paper)
    pairwise_damping(particles, material, for_each_partner, forces);
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "core/cell_grid.h"
#include "core/parallel.h"
#include "physics/forces.h"

namespace sinew {
namespace {

constexpr std::size_t particles_per_piece = 256;

/// From j to i, seen from i. Two particles in one place part along x, the lower id to the left.
Vec3 direction(const Particles& particles, const Vec3& offset, double d, std::size_t i,
               std::size_t j) {
  return d > 0 ? Vec3(offset / d) : Vec3(particles.id[i] < particles.id[j] ? -1 : 1, 0, 0);
}

/// Calls visit(j, offset, d) for every partner j of particle i: x_i - x_j and its length d < b.
template <class Visit>
void for_each_partner(const Particles& particles, const CellGrid& cells, double b, std::size_t i,
                      Visit&& visit) {
  const Vec3 here = particles.position(i);
  cells.for_each_near(here, [&](std::uint32_t j) {
    if (j == i) return;
    const Vec3 offset = here - particles.position(j);
    const double squared = offset.squaredNorm();
    if (squared < b * b) visit(j, offset, std::sqrt(squared));
  });
}

/// Pair force and eq. 2 as the paper has it: towards the mean velocity of the partners.
void paper_pass(const Particles& particles, const CellGrid& cells, const Material& material,
                std::size_t i, Forces& forces) {
  Vec3 force = Vec3::Zero(), velocities = Vec3::Zero();
  int count = 0;
  for_each_partner(particles, cells, material.pair.b, i,
                   [&](std::uint32_t j, const Vec3& offset, double d) {
                     force += material.pair.force(d) * direction(particles, offset, d, i, j);
                     velocities += particles.velocity(j);
                     ++count;
                   });
  forces.pair[i] = force;
  forces.neighbours[i] = count;
  forces.damping[i] = Vec3::Zero();
  if (count > 0 && material.damping > 0)
    forces.damping[i] = -material.damping * (particles.velocity(i) - velocities / count);
}

/// Damping by pairs with the mean of both counts, which must be known: keeps momentum, and with
/// only the part along the pair (central) angular momentum as well.
void pairwise_damping(const Particles& particles, const CellGrid& cells, const Material& material,
                      std::size_t i, Forces& forces) {
  Vec3 sum = Vec3::Zero();
  const bool central = material.damping_form == DampingForm::central;
  for_each_partner(
      particles, cells, material.pair.b, i, [&](std::uint32_t j, const Vec3& offset, double d) {
        const double share = (1.0 / forces.neighbours[i] + 1.0 / forces.neighbours[j]) / 2;
        const Vec3 approach = particles.velocity(i) - particles.velocity(j);
        const Vec3 along = direction(particles, offset, d, i, j);
        sum += share * (central ? Vec3(approach.dot(along) * along) : approach);
      });
  forces.damping[i] = -material.damping * sum;
}

CellGrid cells_of(const Particles& particles, double range) {
  return {particles.x, particles.y, particles.z, range};
}

template <class Visit>
void for_each_particle(const Particles& particles, Visit&& visit) {
  parallel_for(particles.size(), particles_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) visit(i);
  });
}

}  // namespace

void pair_forces(const Particles& particles, const Material& material, Forces& forces) {
  forces.pair.resize(particles.size());
  forces.damping.resize(particles.size());
  forces.neighbours.resize(particles.size());
  const CellGrid cells = cells_of(particles, material.pair.b);
  for_each_particle(particles,
                    [&](std::size_t i) { paper_pass(particles, cells, material, i, forces); });
  if (material.damping_form == DampingForm::paper) return;
  for_each_particle(
      particles, [&](std::size_t i) { pairwise_damping(particles, cells, material, i, forces); });
}

double pair_energy(const Particles& particles, const PairForce& pair) {
  const CellGrid cells = cells_of(particles, pair.b);
  return parallel_sum(
      particles.size(), particles_per_piece, [&](std::size_t begin, std::size_t end) {
        double sum = 0;
        for (std::size_t i = begin; i < end; ++i)
          for_each_partner(particles, cells, pair.b, i, [&](std::uint32_t, const Vec3&, double d) {
            sum += pair.potential(d) / 2;  // half for each of the two
          });
        return sum;
      });
}

}  // namespace sinew

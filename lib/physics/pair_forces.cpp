// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/pair_pass.h"

namespace sinew {

void pairwise_damping(const Particles& particles, const CellGrid& cells, const Material& material,
                      Forces& forces) {
  const bool central = material.damping_form == DampingForm::central;
  for_each_particle(particles.size(), [&](std::size_t i) {
    Vec3 sum = Vec3::Zero();
    for_each_partner(
        particles, cells, material.pair.b, i, [&](std::uint32_t j, const Vec3& offset, double d) {
          const double share = (1.0 / forces.neighbours[i] + 1.0 / forces.neighbours[j]) / 2;
          const Vec3 approach = particles.velocity(i) - particles.velocity(j);
          const Vec3 along = direction_from(particles, offset, d, i, j);
          sum += share * (central ? Vec3(approach.dot(along) * along) : approach);
        });
    forces.damping[i] = -material.damping * sum;
  });
}

void pair_forces(const Particles& particles, const Material& material, Forces& forces) {
  pair_pass(
      particles, material,
      [&](std::size_t, std::uint32_t, double d) { return material.pair.force(d); }, forces);
}

double pair_energy(const Particles& particles, const PairForce& pair) {
  const CellGrid cells = cells_of(particles, pair.b);
  return sum_over_particles(particles.size(), [&](std::size_t i) {
    double sum = 0;
    for_each_partner(particles, cells, pair.b, i, [&](std::uint32_t, const Vec3&, double d) {
      sum += pair.potential(d) / 2;  // half for each of the two
    });
    return sum;
  });
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// One walk through all pairs: what pushes them, who is whose partner, and the damping of eq. 2.
#pragma once

#include "physics/forces.h"
#include "physics/partners.h"

namespace sinew {

/// push(i, j, d) is the force along a pair at distance d (N; positive repels). Fills pair, damping
/// and neighbours.
template <class Push>
void pair_pass(const Particles& particles, const Material& material, const Push& push,
               Forces& forces);

/// Damping by pairs with the mean of both counts, which must be known: keeps momentum, and with
/// only the part along the pair (central) angular momentum as well.
void pairwise_damping(const Particles& particles, const CellGrid& cells, const Material& material,
                      Forces& forces);

template <class Push>
void pair_pass(const Particles& particles, const Material& material, const Push& push,
               Forces& forces) {
  forces.pair.resize(particles.size());
  forces.damping.resize(particles.size());
  forces.neighbours.resize(particles.size());
  const CellGrid cells = cells_of(particles, material.pair.b);
  for_each_particle(particles.size(), [&](std::size_t i) {
    Vec3 force = Vec3::Zero(), velocities = Vec3::Zero();
    int count = 0;
    for_each_partner(particles, cells, material.pair.b, i,
                     [&](std::uint32_t j, const Vec3& offset, double d) {
                       force += push(i, j, d) * direction_from(particles, offset, d, i, j);
                       velocities += particles.velocity(j);
                       ++count;
                     });
    forces.pair[i] = force;
    forces.neighbours[i] = count;
    forces.damping[i] = Vec3::Zero();
    if (count > 0 && material.damping > 0)  // towards the partners' mean velocity
      forces.damping[i] = -material.damping * (particles.velocity(i) - velocities / count);
  });
  if (material.damping_form != DampingForm::paper)
    pairwise_damping(particles, cells, material, forces);
}

}  // namespace sinew

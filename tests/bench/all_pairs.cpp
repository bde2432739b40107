// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include <sinew/core/parallel.h>

#include "bench/all_pairs.h"

namespace sinew::bench {
namespace {

constexpr std::size_t particles_per_piece = 64;

void pairs_of(std::size_t i, const Particles& particles, const Material& material, Forces& forces) {
  const double b = material.pair.b;
  const Vec3 here = particles.position(i);
  Vec3 force = Vec3::Zero(), velocities = Vec3::Zero();
  int count = 0;
  for (std::size_t j = 0; j < particles.size(); ++j) {
    const Vec3 offset = here - particles.position(j);
    const double squared = offset.squaredNorm();
    if (squared >= b * b || j == i) continue;
    const double d = std::sqrt(squared);
    force += material.pair.force(d) / d * offset;
    velocities += particles.velocity(j);
    ++count;
  }
  forces.pair[i] = force;
  forces.neighbors[i] = count;
  forces.damping[i] = Vec3::Zero();
  if (count > 0)
    forces.damping[i] = material.damping * (velocities / count - particles.velocity(i));
}

}  // namespace

void all_pair_forces(const Particles& particles, const Material& material, Forces& forces) {
  const std::size_t n = particles.size();
  forces.pair.resize(n);
  forces.damping.resize(n);
  forces.neighbors.resize(n);
  parallel_for(n, particles_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) pairs_of(i, particles, material, forces);
  });
}

void step_all_pairs(Particles& particles, const Body& body, const Pose& pose, double step,
                    Forces& forces) {
  all_pair_forces(particles, body.material, forces);
  bone_forces(particles, body, pose, forces);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const Vec3 v = particles.velocity(i) + step / particles.mass * forces.total(i);
    particles.set_velocity(i, v);
    particles.set_position(i, particles.position(i) + step * v);
  }
}

}  // namespace sinew::bench

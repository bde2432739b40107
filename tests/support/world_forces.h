// SPDX-License-Identifier: GPL-3.0-or-later
// The forces of a world on many particles at once, part by part.
#pragma once

#include <sinew/world/world.h>

namespace sinew::test {

struct WorldForces {
  Points contact, drag, field, muscle, losing;
  std::vector<double> power, losing_power;
  std::vector<Reaction> reactions;
  double contact_energy = 0;
  FiberEnergy muscle_energy;

  Vec3 total(std::size_t i) const { return contact[i] + drag[i] + field[i] + muscle[i]; }
};

/// Powers put in and lost, W.
struct WorldPowers {
  double obstacles = 0, fields = 0, muscles = 0, lost = 0;
};

inline ParticleState particle_of(const Particles& particles, std::size_t i) {
  return {{}, particles.position(i), particles.velocity(i), particles.radius};
}

/// Without the friction that stops sliding.
inline void world_forces(const Particles& particles, const World& world, const WorldNow& now,
                         WorldForces& forces) {
  forces = {};
  forces.reactions.resize(world.obstacles.size());
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const ParticleWorld on = world_on(particle_of(particles, i), particles.mass, world, now,
                                      Vec3::Zero(), 0, forces.reactions);
    forces.contact.push_back(on.contact);
    forces.drag.push_back(on.drag);
    forces.field.push_back(on.field);
    forces.losing.push_back(on.losing);
    forces.power.push_back(on.power);
    forces.losing_power.push_back(on.losing_power);
    forces.contact_energy += on.contact_energy;
  }
  forces.muscle_energy = muscle_forces(world.muscles, now.activations, particles, forces.muscle);
}

/// Adds that friction; `others`: all other forces on each particle, those of the world included, N.
inline void stop_sliding(const Particles& particles, const World& world, const WorldNow& now,
                         const Points& others, double step, WorldForces& forces) {
  for (std::size_t i = 0; i < particles.size(); ++i) {
    std::vector<Reaction> without(world.obstacles.size()), with(world.obstacles.size());
    const ParticleState one = particle_of(particles, i);
    const ParticleWorld bare = world_on(one, particles.mass, world, now, Vec3::Zero(), 0, without);
    const ParticleWorld whole =
        world_on(one, particles.mass, world, now, others[i] - bare.force(), step, with);
    const Vec3 friction = whole.contact - bare.contact;
    forces.contact[i] += friction;
    forces.losing[i] += friction;
    forces.power[i] += whole.power - bare.power;
    forces.losing_power[i] += whole.losing_power - bare.losing_power;
    for (std::size_t k = 0; k < with.size(); ++k) {
      forces.reactions[k].force += with[k].force - without[k].force;
      forces.reactions[k].moment += with[k].moment - without[k].moment;
    }
  }
}

/// While the particles move at `velocities` (m/s).
inline WorldPowers world_powers(const WorldForces& forces, const Points& velocities) {
  WorldPowers powers;
  for (std::size_t i = 0; i < velocities.size(); ++i) {
    powers.obstacles += forces.power[i];
    powers.fields += forces.field[i].dot(velocities[i]);
    powers.muscles += forces.muscle[i].dot(velocities[i]);
    powers.lost += forces.losing_power[i] - forces.losing[i].dot(velocities[i]);
  }
  return powers;
}

}  // namespace sinew::test

// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/physics/world/world.h>

#include <algorithm>
#include <functional>

#include <sinew/core/parallel.h>
#include <sinew/core/particles.h>

namespace sinew {
namespace {

constexpr std::size_t particles_per_world_task = 1024;
constexpr std::size_t most_contacts = 3;  // of one particle at once, for the step limit

/// Contributions of the particles of one piece to the sums.
struct PieceSums {
  double energy = 0;
  std::vector<Reaction> reactions;
};

void resize(WorldForces& forces, std::size_t n) {
  for (Points* part : {&forces.contact, &forces.drag, &forces.field, &forces.losing})
    part->assign(n, Vec3::Zero());
  forces.power.assign(n, 0.0);
  forces.losing_power.assign(n, 0.0);
}

/// Ledgers a force on particle i whose source moves at `velocity` there; `losing` is part of it.
void ledger(WorldForces& forces, std::size_t i, const Vec3& force, const Vec3& losing,
            const Vec3& velocity) {
  forces.losing[i] += losing;
  forces.power[i] += force.dot(velocity);
  forces.losing_power[i] += losing.dot(velocity);
}

/// Adds what obstacle k does to particle i, and its reaction; `losing` is part of `force`.
void add_contact(const Particles& particles, std::size_t i, const ObstaclePose& pose,
                 const Vec3& force, const Vec3& losing, WorldForces& forces, Reaction& reaction) {
  const Vec3 position = particles.position(i);
  forces.contact[i] += force;
  ledger(forces, i, force, losing, pose.velocity_at(position));
  reaction.force -= force;
  reaction.moment -= (position - pose.frame.origin).cross(force);
}

Contact contact_of(const Particles& particles, std::size_t i, const Obstacle& obstacle,
                   const ObstaclePose& pose) {
  return contact(obstacle, pose, particles.position(i), particles.velocity(i), particles.radius);
}

void add_contacts(const Particles& particles, const World& world, const WorldNow& now,
                  std::size_t i, WorldForces& forces, PieceSums& sums) {
  for (std::size_t k = 0; k < world.obstacles.size(); ++k) {
    const ObstaclePose& pose = now.obstacles[k];
    const Contact touch = contact_of(particles, i, world.obstacles[k], pose);
    if (!(touch.pressing > 0)) continue;
    add_contact(particles, i, pose, touch.force(), touch.losing(), forces, sums.reactions[k]);
    sums.energy += touch.energy;
  }
}

void add_stopping(const Particles& particles, const World& world, const WorldNow& now,
                  const Vec3& others, double step, std::size_t i, WorldForces& forces,
                  PieceSums& sums) {
  const double mass = particles.mass;
  Vec3 velocity = particles.velocity(i) + step / mass * others;
  for (std::size_t k = 0; k < world.obstacles.size(); ++k) {
    const Obstacle& obstacle = world.obstacles[k];
    if (obstacle.stick > 0 || obstacle.friction == 0) continue;
    const ObstaclePose& pose = now.obstacles[k];
    const Contact touch = contact_of(particles, i, obstacle, pose);
    if (!(touch.pressing > 0)) continue;
    const Vec3 relative = velocity - pose.velocity_at(particles.position(i));
    const Vec3 friction = stopping_friction(obstacle, touch, relative, mass, step);
    add_contact(particles, i, pose, friction, friction, forces, sums.reactions[k]);
    velocity += step / mass * friction;
  }
}

void add_drag(const Particles& particles, const Drag& drag, std::size_t i, WorldForces& forces) {
  if (drag.rate == 0) return;
  forces.drag[i] = -drag.rate * particles.mass * (particles.velocity(i) - drag.velocity);
  ledger(forces, i, forces.drag[i], forces.drag[i], drag.velocity);
}

void add_fields(const Particles& particles, const World& world, const WorldNow& now, std::size_t i,
                WorldForces& forces) {
  const Grain grain = {particles.mass, volume_per_particle(particles.radius)};
  for (std::size_t k = 0; k < world.fields.size(); ++k)
    forces.field[i] += field_force(world.fields[k], now.scales[k], particles.position(i), grain);
}

/// Adds the sums of the pieces in their order, whichever thread computed them.
void add_up(const std::vector<PieceSums>& pieces, WorldForces& forces) {
  for (const PieceSums& piece : pieces) {
    forces.contact_energy += piece.energy;
    for (std::size_t k = 0; k < forces.reactions.size(); ++k) {
      forces.reactions[k].force += piece.reactions[k].force;
      forces.reactions[k].moment += piece.reactions[k].moment;
    }
  }
}

/// Calls act(i, sums of its piece) for all particles and adds up.
template <class Act>
void for_each_particle(std::size_t n, WorldForces& forces, const Act& act) {
  std::vector<PieceSums> pieces((n + particles_per_world_task - 1) / particles_per_world_task);
  parallel_for(n, particles_per_world_task, [&](std::size_t begin, std::size_t end) {
    PieceSums& sums = pieces[begin / particles_per_world_task];
    sums.reactions.resize(forces.reactions.size());
    for (std::size_t i = begin; i < end; ++i) act(i, sums);
  });
  add_up(pieces, forces);
}

double sum_of_products(const Points& a, const Points& b) {
  return parallel_sum(a.size(), particles_per_world_task, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += a[i].dot(b[i]);
    return sum;
  });
}

double sum_of(const std::vector<double>& values) {
  return parallel_sum(values.size(), particles_per_world_task,
                      [&](std::size_t begin, std::size_t end) {
                        double sum = 0;
                        for (std::size_t i = begin; i < end; ++i) sum += values[i];
                        return sum;
                      });
}

/// The sum of the values that can act on one particle at once.
double largest_few(std::vector<double> values) {
  std::sort(values.begin(), values.end(), std::greater<>());
  values.resize(std::min(values.size(), most_contacts));
  double sum = 0;
  for (const double value : values) sum += value;
  return sum;
}

}  // namespace

bool has_muscles(const Body& body) { return body.world && !body.world->muscles.active.empty(); }

WorldNow world_at(const World& world, double time, const Pose& pose) {
  WorldNow now;
  for (const Obstacle& obstacle : world.obstacles) now.obstacles.push_back(obstacle.at(time, pose));
  for (const ForceField& field : world.fields) now.scales.push_back(field.scale.at(time));
  now.activations = activations_at(world.muscles, time);
  return now;
}

void world_forces(const Particles& particles, const World& world, const WorldNow& now,
                  WorldForces& forces) {
  resize(forces, particles.size());
  forces.contact_energy = 0;
  forces.reactions.assign(world.obstacles.size(), {});
  for_each_particle(particles.size(), forces, [&](std::size_t i, PieceSums& sums) {
    add_contacts(particles, world, now, i, forces, sums);
    add_drag(particles, world.drag, i, forces);
    add_fields(particles, world, now, i, forces);
  });
  forces.muscle_energy = muscle_forces(world.muscles, now.activations, particles, forces.muscle);
}

void stop_sliding(const Particles& particles, const World& world, const WorldNow& now,
                  const Points& others, double step, WorldForces& forces) {
  for_each_particle(particles.size(), forces, [&](std::size_t i, PieceSums& sums) {
    if (forces.contact[i].isZero(0)) return;
    add_stopping(particles, world, now, others[i], step, i, forces, sums);
  });
}

WorldPowers world_powers(const WorldForces& forces, const Points& velocities) {
  WorldPowers powers;
  powers.obstacles = sum_of(forces.power);
  powers.fields = sum_of_products(forces.field, velocities);
  powers.muscles = sum_of_products(forces.muscle, velocities);
  powers.lost = sum_of(forces.losing_power) - sum_of_products(forces.losing, velocities);
  return powers;
}

ParticleWorld world_on(const HeldParticle& particle, double mass, const World& world,
                       const WorldNow& now, const Vec3& others, double step,
                       std::span<Reaction> reactions) {
  ParticleWorld on;
  const auto add = [&](const Vec3& force, const Vec3& losing, const Vec3& source) {
    on.force += force;
    on.losing += losing;
    on.power += force.dot(source);
    on.losing_power += losing.dot(source);
  };
  const auto add_contact = [&](std::size_t k, const Vec3& force, const Vec3& losing) {
    const ObstaclePose& pose = now.obstacles[k];
    add(force, losing, pose.velocity_at(particle.position));
    reactions[k].force -= force;
    reactions[k].moment -= (particle.position - pose.frame.origin).cross(force);
  };
  const auto contact_with = [&](std::size_t k) {
    return contact(world.obstacles[k], now.obstacles[k], particle.position, particle.velocity,
                   particle.radius);
  };
  bool touched = false;
  for (std::size_t k = 0; k < world.obstacles.size(); ++k) {
    const Contact touch = contact_with(k);
    if (!(touch.pressing > 0)) continue;
    touched = true;
    add_contact(k, touch.force(), touch.losing());
    on.contact_energy += touch.energy;
  }
  if (world.drag.rate > 0) {
    const Vec3 drag = -world.drag.rate * mass * (particle.velocity - world.drag.velocity);
    add(drag, drag, world.drag.velocity);
  }
  const Grain grain = {mass, volume_per_particle(particle.radius)};
  for (std::size_t k = 0; k < world.fields.size(); ++k)
    on.field += field_force(world.fields[k], now.scales[k], particle.position, grain);
  on.force += on.field;
  if (!touched) return on;
  Vec3 velocity = particle.velocity + step / mass * (others + on.force);
  for (std::size_t k = 0; k < world.obstacles.size(); ++k) {
    const Obstacle& obstacle = world.obstacles[k];
    if (obstacle.stick > 0 || obstacle.friction == 0) continue;
    const Contact touch = contact_with(k);
    if (!(touch.pressing > 0)) continue;
    const Vec3 relative = velocity - now.obstacles[k].velocity_at(particle.position);
    const Vec3 friction = stopping_friction(obstacle, touch, relative, mass, step);
    add_contact(k, friction, friction);
    velocity += step / mass * friction;
  }
  return on;
}

double added_stiffness(const World& world, const Particles& particles) {
  const Grain grain = {particles.mass, volume_per_particle(particles.radius)};
  std::vector<double> springs;
  for (const Obstacle& obstacle : world.obstacles) springs.push_back(obstacle.stiffness);
  double sum = largest_few(springs) + muscle_stiffness(world.muscles, particles.radius);
  for (const ForceField& field : world.fields) sum += field_stiffness(field, grain);
  return sum;
}

double added_damping(const World& world, const Particles& particles) {
  std::vector<double> brakes;
  for (const Obstacle& obstacle : world.obstacles)
    brakes.push_back(std::max(obstacle.damping, obstacle.friction > 0 ? obstacle.stick : 0.0));
  return world.drag.rate + largest_few(brakes) / particles.mass;
}

void check_world(const World& world) {
  for (const Obstacle& obstacle : world.obstacles) check_obstacle(obstacle);
  for (const ForceField& field : world.fields) check_field(field);
  check_drag(world.drag);
}

}  // namespace sinew

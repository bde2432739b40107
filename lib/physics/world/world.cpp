// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/world/world.h"

#include <algorithm>
#include <functional>

#include "core/closest_packing.h"
#include "core/parallel.h"

namespace sinew {
namespace {

constexpr std::size_t particles_per_piece = 1024;
constexpr std::size_t most_contacts = 3;  // of one particle at once, for the limits of the step

/// What the particles of one piece give to the sums over all.
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

/// Books a force on particle i whose source moves at `velocity` there; `losing` is part of it.
void book(WorldForces& forces, std::size_t i, const Vec3& force, const Vec3& losing,
          const Vec3& velocity) {
  forces.losing[i] += losing;
  forces.power[i] += force.dot(velocity);
  forces.losing_power[i] += losing.dot(velocity);
}

void add_contacts(const Particles& particles, const World& world, const WorldNow& now,
                  std::size_t i, WorldForces& forces, PieceSums& sums) {
  const Vec3 position = particles.position(i), velocity = particles.velocity(i);
  for (std::size_t k = 0; k < world.obstacles.size(); ++k) {
    const ObstaclePose& pose = now.obstacles[k];
    const Contact touch = contact(world.obstacles[k], pose, position, velocity, particles.radius);
    const Vec3 force = touch.force();
    if (force.isZero(0)) continue;
    forces.contact[i] += force;
    book(forces, i, force, touch.losing(), pose.velocity_at(position));
    sums.energy += touch.energy;
    sums.reactions[k].force -= force;
    sums.reactions[k].moment -= (position - pose.frame.origin).cross(force);
  }
}

void add_drag(const Particles& particles, const Drag& drag, std::size_t i, WorldForces& forces) {
  if (drag.rate == 0) return;
  forces.drag[i] = -drag.rate * particles.mass * (particles.velocity(i) - drag.velocity);
  book(forces, i, forces.drag[i], forces.drag[i], drag.velocity);
}

void add_fields(const Particles& particles, const World& world, const WorldNow& now, std::size_t i,
                WorldForces& forces) {
  const Grain grain = {particles.mass, volume_per_particle(particles.radius)};
  for (std::size_t k = 0; k < world.fields.size(); ++k)
    forces.field[i] += field_force(world.fields[k], now.scales[k], particles.position(i), grain);
}

/// In the order of the pieces, whichever thread made them.
void add_up(const std::vector<PieceSums>& pieces, WorldForces& forces) {
  for (const PieceSums& piece : pieces) {
    forces.contact_energy += piece.energy;
    for (std::size_t k = 0; k < forces.reactions.size(); ++k) {
      forces.reactions[k].force += piece.reactions[k].force;
      forces.reactions[k].moment += piece.reactions[k].moment;
    }
  }
}

double sum_of_products(const Points& a, const Points& b) {
  return parallel_sum(a.size(), particles_per_piece, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += a[i].dot(b[i]);
    return sum;
  });
}

double sum_of(const std::vector<double>& values) {
  return parallel_sum(values.size(), particles_per_piece, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += values[i];
    return sum;
  });
}

/// The sum of what a particle can meet at once.
double largest_few(std::vector<double> values) {
  std::sort(values.begin(), values.end(), std::greater<>());
  values.resize(std::min(values.size(), most_contacts));
  double sum = 0;
  for (const double value : values) sum += value;
  return sum;
}

}  // namespace

WorldNow world_at(const World& world, double time, const Pose& pose) {
  WorldNow now;
  for (const Obstacle& obstacle : world.obstacles) now.obstacles.push_back(obstacle.at(time, pose));
  for (const ForceField& field : world.fields) now.scales.push_back(field.scale.at(time));
  now.activations = activations_at(world.muscles, time);
  return now;
}

void world_forces(const Particles& particles, const World& world, const WorldNow& now,
                  WorldForces& forces) {
  const std::size_t n = particles.size();
  resize(forces, n);
  std::vector<PieceSums> pieces((n + particles_per_piece - 1) / particles_per_piece);
  parallel_for(n, particles_per_piece, [&](std::size_t begin, std::size_t end) {
    PieceSums& sums = pieces[begin / particles_per_piece];
    sums.reactions.resize(world.obstacles.size());
    for (std::size_t i = begin; i < end; ++i) {
      add_contacts(particles, world, now, i, forces, sums);
      add_drag(particles, world.drag, i, forces);
      add_fields(particles, world, now, i, forces);
    }
  });
  forces.contact_energy = 0;
  forces.reactions.assign(world.obstacles.size(), {});
  add_up(pieces, forces);
  forces.muscle_energy = muscle_forces(world.muscles, now.activations, particles, forces.muscle);
}

WorldPowers world_powers(const WorldForces& forces, const Points& velocities) {
  WorldPowers powers;
  powers.obstacles = sum_of(forces.power);
  powers.fields = sum_of_products(forces.field, velocities);
  powers.muscles = sum_of_products(forces.muscle, velocities);
  powers.lost = sum_of(forces.losing_power) - sum_of_products(forces.losing, velocities);
  return powers;
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

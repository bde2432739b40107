// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/world/world.h>

#include <algorithm>
#include <functional>

#include <sinew/core/particles.h>

namespace sinew {
namespace {

constexpr std::size_t max_contacts = 3;  // contacts of one particle at once, for the step limit

/// Gathers the forces on one particle.
class Gatherer {
 public:
  Gatherer(const ParticleState& particle, double mass, const World& world, const WorldNow& now,
           std::span<Reaction> reactions)
      : particle_(particle), mass_(mass), world_(world), now_(now), reactions_(reactions) {}

  void add_contacts() {
    for (std::size_t k = 0; k < world_.obstacles.size(); ++k) {
      const Contact touch = contact_with(k);
      if (!(touch.pressing > 0)) continue;
      add_contact(k, touch.force(), touch.losing());
      on.contact_energy += touch.energy;
      touched_ = true;
    }
  }

  void add_drag() {
    if (world_.drag.rate == 0) return;
    on.drag = -world_.drag.rate * mass_ * (particle_.velocity - world_.drag.velocity);
    ledger(on.drag, on.drag, world_.drag.velocity);
  }

  void add_fields() {
    const ParticleInfo grain = {mass_, volume_per_particle(particle_.radius), particle_.id};
    for (std::size_t k = 0; k < world_.fields.size(); ++k)
      on.field += field_force(world_.fields[k], now_.scales[k], particle_.position, grain);
  }

  void add_stopping(const Vec3& others, double step) {
    if (!touched_ || step == 0) return;
    Vec3 velocity = particle_.velocity + step / mass_ * (others + on.force());
    for (std::size_t k = 0; k < world_.obstacles.size(); ++k) {
      const Obstacle& obstacle = world_.obstacles[k];
      if (obstacle.stick > 0 || obstacle.friction == 0) continue;
      const Contact touch = contact_with(k);
      if (!(touch.pressing > 0)) continue;
      const Vec3 relative = velocity - now_.obstacles[k].velocity_at(particle_.position);
      const Vec3 friction =
          stopping_friction(obstacle, now_.obstacles[k].friction, touch, relative, mass_, step);
      add_contact(k, friction, friction);
      velocity += step / mass_ * friction;
    }
  }

  ParticleWorld on;

 private:
  Contact contact_with(std::size_t k) const {
    return contact(world_.obstacles[k], now_.obstacles[k], particle_.position, particle_.velocity,
                   particle_.radius);
  }

  /// A force whose source moves at `velocity` there; `losing` is part of it.
  void ledger(const Vec3& force, const Vec3& losing, const Vec3& velocity) {
    on.losing += losing;
    on.power += force.dot(velocity);
    on.losing_power += losing.dot(velocity);
  }

  void add_contact(std::size_t k, const Vec3& force, const Vec3& losing) {
    const ObstaclePose& pose = now_.obstacles[k];
    on.contact += force;
    ledger(force, losing, pose.velocity_at(particle_.position));
    reactions_[k].force -= force;
    reactions_[k].moment -= (particle_.position - pose.frame.origin).cross(force);
  }

  const ParticleState& particle_;
  double mass_;
  const World& world_;
  const WorldNow& now_;
  std::span<Reaction> reactions_;
  bool touched_ = false;
};

/// The sum of the values that can act on one particle at once.
double largest_few(std::vector<double> values) {
  std::sort(values.begin(), values.end(), std::greater<>());
  values.resize(std::min(values.size(), max_contacts));
  double sum = 0;
  for (const double value : values) sum += value;
  return sum;
}

}  // namespace

bool has_muscles(const Body& body) { return body.world && !body.world->muscles.active.empty(); }

std::vector<Reaction> reactions_through_obstacles(const World& world,
                                                  const std::vector<Reaction>& on, double time,
                                                  const Pose& pose) {
  std::vector<Reaction> all;
  for (std::size_t k = 0; k < world.obstacles.size(); ++k) {
    if (world.obstacles[k].bone == no_bone) continue;
    const ObstaclePose now = world.obstacles[k].at(time, pose);
    const auto bone = static_cast<std::size_t>(world.obstacles[k].bone);
    const Vec3 arm = now.frame.origin - pose[bone].frame.origin;
    const double power = -on[k].force.dot(now.velocity) - on[k].moment.dot(now.angular_velocity);
    all.resize(pose.size());
    all[bone] += {on[k].force, on[k].moment + arm.cross(on[k].force), power};
  }
  return all;
}

WorldNow world_at(const World& world, double time, const Pose& pose) {
  WorldNow now;
  for (const Obstacle& obstacle : world.obstacles) now.obstacles.push_back(obstacle.at(time, pose));
  for (const ForceField& field : world.fields) now.scales.push_back(field.scale.at(time));
  now.activations = activations_at(world.muscles, time);
  now.supports = poses_of(world.supports, time, pose);
  for (const Load& load : world.loads) now.loads.push_back(load.at(time));
  return now;
}

PinPose held_place(const Pinned& held, const Vec3& rest, const World& world,
                   std::span<const ObstaclePose> supports, const Skeleton& skeleton,
                   const Pose& pose) {
  return held.is_pin() ? pin_pose(held, rest, skeleton, pose)
                       : place_of(held, rest, world.supports, supports);
}

ParticleWorld world_on(const ParticleState& particle, double mass, const World& world,
                       const WorldNow& now, const Vec3& others, double step,
                       std::span<Reaction> reactions) {
  Gatherer gatherer(particle, mass, world, now, reactions);
  gatherer.add_contacts();
  gatherer.add_drag();
  gatherer.add_fields();
  gatherer.add_stopping(others, step);
  return gatherer.on;
}

double added_stiffness(const World& world, const Particles& particles) {
  const ParticleInfo grain = {particles.mass, volume_per_particle(particles.radius)};
  std::vector<double> springs;
  for (const Obstacle& obstacle : world.obstacles) springs.push_back(obstacle.stiffness);
  double sum = largest_few(springs) + muscle_stiffness(world.muscles, particles.radius);
  for (const ForceField& field : world.fields) sum += field_stiffness(field, grain);
  for (const Load& load : world.loads) sum += load_stiffness(load, particles.radius);
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
  for (const Load& load : world.loads) check_load(load);
  check_drag(world.drag);
}

}  // namespace sinew

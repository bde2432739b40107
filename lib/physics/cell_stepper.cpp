// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/cell_stepper.h"

#include <atomic>
#include <utility>

#include "core/parallel.h"

namespace sinew {
namespace {

constexpr std::size_t particles_per_piece = 512;

std::optional<Solid> solid_of(const Body& body, const Particles& particles) {
  if (!remembers_neighbours(body.material)) return std::nullopt;
  Points rest;
  rest.reserve(particles.size());
  for (const std::int32_t id : particles.id) rest.push_back(body.rest[id]);
  return Solid(body.material, std::move(rest));
}

}  // namespace

CellStepper::CellStepper(std::shared_ptr<const Body> body, const Stepping& stepping,
                         Particles particles)
    : body_(std::move(body)), stepping_(stepping), particles_(std::move(particles)) {
  solid_ = solid_of(*body_, particles_);
}

void CellStepper::find_forces(const Pose& pose) {
  if (solid_)
    solid_->forces(particles_, forces_);
  else
    pair_forces(particles_, body_->material, forces_);
  bone_forces(particles_, *body_, pose, forces_);
}

double CellStepper::stored_in_pairs() {
  return solid_ ? solid_->energy(particles_) : pair_energy(particles_, body_->material.pair);
}

std::span<const std::int32_t> CellStepper::broken_bonds() const {
  if (!solid_ || body_->material.model == MaterialModel::paper) return {};
  return solid_->bonds().broken;
}

void CellStepper::save(SimulationState& state) const {
  const Particles& now = particles_;
  state.moving = MovingInDouble{{now.x, now.y, now.z}, {now.u, now.v, now.w}};
  state.kicked = kicked_;
  if (!solid_) return;
  state.rest_length = solid_->bonds().rest_length;
  state.broken = solid_->bonds().broken;
}

void CellStepper::restore(const SimulationState& state) {
  const auto* moving = std::get_if<MovingInDouble>(&state.moving);
  if (moving == nullptr) throw not_a_state("it is in single precision");
  check_moving(*moving, particles_.size());
  if (solid_)
    solid_->restore(state.rest_length, state.broken);
  else if (!state.rest_length.empty())
    throw not_a_state("it has bonds");
  Particles& now = particles_;
  now.x = moving->x[0], now.y = moving->x[1], now.z = moving->x[2];
  now.u = moving->v[0], now.v = moving->v[1], now.w = moving->v[2];
  kicked_ = state.kicked;
}

Vec3 CellStepper::acceleration(std::size_t i) const {
  return forces_.total(i) / particles_.mass + stepping_.gravity;
}

StepSums CellStepper::sums() const {
  const std::size_t n = particles_.size();
  StepSums sums;
  sums.power = parallel_sum(n, particles_per_piece, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += forces_.bone_power[i];
    return sum;
  });
  sums.lost = parallel_sum(n, particles_per_piece, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) {
      // Velocities are half a step behind the forces here, for velocity Verlet as well.
      const Vec3 velocity = particles_.velocity(i) + stepping_.step / 2 * acceleration(i);
      sum += forces_.bone_damping_power[i] - forces_.bone_damping[i].dot(velocity) -
             forces_.damping[i].dot(velocity);
    }
    return sum;
  });
  return sums;
}

void CellStepper::advance(std::size_t i, double kick) {
  const Vec3 x = particles_.position(i), v = particles_.velocity(i);
  const Vec3 kicked = v + kick * acceleration(i);
  const bool drift_first = stepping_.integrator == Integrator::explicit_euler;
  particles_.set_position(i, x + stepping_.step * (drift_first ? v : kicked));
  particles_.set_velocity(i, kicked);
}

bool CellStepper::sound(std::size_t i, const Vec3& before, const Pose& pose) const {
  const auto bones = body_->binding.of(particles_.id[i]);
  const Vec3 moved = particles_.position(i) - before;
  const Vec3 ridden = bones.empty()
                          ? Vec3(Vec3::Zero())
                          : Vec3(stepping_.step * pose[bones.front().bone].velocity_at(before));
  const double most = most_radii_per_step * particles_.radius;
  // False for values that are not numbers as well.
  return (moved - ridden).squaredNorm() <= most * most && particles_.velocity(i).allFinite();
}

StepSums CellStepper::step(const Pose& pose) {
  find_forces(pose);
  StepSums sums = this->sums();
  if (solid_) sums.lost += solid_->evolve(particles_, stepping_.step) / stepping_.step;
  const bool half = stepping_.integrator == Integrator::velocity_verlet && !kicked_;
  const double kick = half ? stepping_.step / 2 : stepping_.step;
  const std::size_t n = particles_.size();
  std::atomic<std::size_t> first_bad = n;
  parallel_for(n, particles_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 before = particles_.position(i);
      advance(i, kick);
      if (sound(i, before, pose)) continue;
      std::size_t least = first_bad;  // the lowest index wins, whichever thread finds it
      while (i < least && !first_bad.compare_exchange_weak(least, i)) {
      }
    }
  });
  if (first_bad < n)
    sums.failure = {first_bad, particles_.position(first_bad).allFinite() &&
                                   particles_.velocity(first_bad).allFinite()};
  kicked_ = true;
  return sums;
}

Balance CellStepper::evaluate(const Pose& pose, Forces& forces) {
  find_forces(pose);
  const StepSums now = sums();
  forces.pair = forces_.pair;
  forces.damping = forces_.damping;
  forces.bone = forces_.bone;
  forces.neighbours = forces_.neighbours;
  return {now.power, now.lost, stored_in_pairs(), bone_energy(particles_, *body_, pose)};
}

void CellStepper::read(const Pose& pose, Particles& particles) {
  particles = particles_;
  if (stepping_.integrator != Integrator::velocity_verlet || !kicked_) return;
  Forces forces;
  evaluate(pose, forces);
  for (std::size_t i = 0; i < particles.size(); ++i)
    particles.set_velocity(i, particles.velocity(i) + stepping_.step / 2 * acceleration(i));
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/simulation.h"

#include <atomic>
#include <utility>

#include "core/error.h"
#include "core/number_text.h"
#include "core/parallel.h"

namespace sinew {
namespace {

constexpr std::size_t particles_per_piece = 512;
// A bond that snaps drives a particle by (b - a) sqrt(k lambda / 3m) dt, 0.1 r at half the limit;
// only a run that has left the range of every limit is faster than several bonds at once.
constexpr double most_radii_per_step = 0.25;

}  // namespace

Stepping stepping_of(const SolverSettings& solver, double step) {
  return {solver.integrator, step, solver.gravity, solver.precision, solver.neighbour_search};
}

Simulation::Simulation(Body body, Motion motion, Particles particles, const Stepping& stepping)
    : body_(std::move(body)),
      motion_(std::move(motion)),
      particles_(std::move(particles)),
      stepping_(stepping) {}

void Simulation::evaluate() {
  if (evaluated_) return;
  pose_ = pose();
  pair_forces(particles_, body_.material, forces_);
  bone_forces(particles_, body_, pose_, forces_);
  account();
  evaluated_ = true;
}

Vec3 Simulation::centred_velocity(std::size_t i) const {
  if (stepping_.integrator == Integrator::velocity_verlet) return particles_.velocity(i);
  return particles_.velocity(i) + stepping_.step / 2 * acceleration(i);
}

/// Power of the bones now, and what the coming step dissipates.
void Simulation::account() {
  const std::size_t n = particles_.size();
  const double power =
      parallel_sum(n, particles_per_piece, [&](std::size_t begin, std::size_t end) {
        double sum = 0;
        for (std::size_t i = begin; i < end; ++i) sum += forces_.bone_power[i];
        return sum;
      });
  const double lost = parallel_sum(n, particles_per_piece, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) {
      // Velocities are half a step behind the forces here: velocity Verlet's second kick comes
      // later.
      const Vec3 velocity = particles_.velocity(i) + stepping_.step / 2 * acceleration(i);
      sum += forces_.bone_damping_power[i] - forces_.bone_damping[i].dot(velocity) -
             forces_.damping[i].dot(velocity);
    }
    return sum;
  });
  if (steps_ > 0) work_ += stepping_.step * (power_ + power) / 2;
  power_ = power;
  dissipated_in_step_ = stepping_.step * lost;
}

void Simulation::advance(std::size_t i) {
  const double dt = stepping_.step;
  const Vec3 x = particles_.position(i), v = particles_.velocity(i), a = acceleration(i);
  switch (stepping_.integrator) {
    case Integrator::symplectic_euler:
      particles_.set_velocity(i, v + dt * a);
      particles_.set_position(i, x + dt * particles_.velocity(i));
      break;
    case Integrator::explicit_euler:
      particles_.set_position(i, x + dt * v);
      particles_.set_velocity(i, v + dt * a);
      break;
    case Integrator::velocity_verlet:  // the second half of the kick follows in step()
      particles_.set_velocity(i, v + dt / 2 * a);
      particles_.set_position(i, x + dt * particles_.velocity(i));
      break;
  }
}

bool Simulation::in_bounds(std::size_t i, const Vec3& before) const {
  const int bone = body_.binding.bone(particles_.id[i]);
  const Vec3 moved = particles_.position(i) - before;
  const Vec3 ridden = stepping_.step * pose_[bone].velocity_at(before);
  const double most = most_radii_per_step * particles_.radius;
  // False for values that are not numbers as well.
  return (moved - ridden).squaredNorm() <= most * most && particles_.velocity(i).allFinite();
}

void Simulation::step() {
  evaluate();
  const std::size_t n = particles_.size();
  std::atomic<std::size_t> first_bad = n;
  parallel_for(n, particles_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 before = particles_.position(i);
      advance(i);
      if (in_bounds(i, before)) continue;
      std::size_t least = first_bad;  // the lowest index wins, whichever thread finds it
      while (i < least && !first_bad.compare_exchange_weak(least, i)) {
      }
    }
  });
  if (first_bad < n) fail(first_bad);
  dissipation_ += dissipated_in_step_;
  ++steps_;
  evaluated_ = false;
  if (stepping_.integrator != Integrator::velocity_verlet) return;
  evaluate();  // with the half-step velocity
  for (std::size_t i = 0; i < n; ++i)
    particles_.set_velocity(i, particles_.velocity(i) + stepping_.step / 2 * acceleration(i));
}

void Simulation::fail(std::size_t i) const {
  const bool finite = particles_.position(i).allFinite() && particles_.velocity(i).allFinite();
  const int bone = body_.binding.bone(particles_.id[i]);
  throw Error(Exit::unstable, "step " + std::to_string(steps_) + " at " + three_digits(time()) +
                                  " s: particle " + std::to_string(particles_.id[i]) +
                                  " on bone '" + body_.skeleton.bones[bone].name +
                                  (finite ? "' moved over " + three_digits(most_radii_per_step) +
                                                " r relative to its bone in one step"
                                          : std::string("' reached a value that is not finite")) +
                                  "; use solver.time_step " + three_digits(stepping_.step / 2) +
                                  " or less");
}

const Forces& Simulation::forces() {
  evaluate();
  return forces_;
}

Energies Simulation::energies() {
  evaluate();
  Energies now;
  const std::size_t n = particles_.size();
  now.kinetic = parallel_sum(n, particles_per_piece, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i)
      sum += particles_.mass / 2 * centred_velocity(i).squaredNorm();
    return sum;
  });
  now.gravity = parallel_sum(n, particles_per_piece, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i)
      sum -= particles_.mass * stepping_.gravity.dot(particles_.position(i));
    return sum;
  });
  now.pair = pair_energy(particles_, body_.material.pair);
  now.bone = bone_energy(particles_, body_, pose_);
  now.work_of_bones = work_;
  now.dissipation = dissipation_ + dissipated_in_step_ / 2;
  return now;
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/thin_body.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "core/closest_packing.h"
#include "core/neighbours.h"
#include "physics/bone_force.h"
#include "physics/solid/solid.h"

namespace sinew {
namespace {

constexpr std::size_t neighbours_inside = 12;
constexpr int rounds = 3, iterations = 120;      // the step is made better after each round
constexpr double margin = 0.99;                  // the iteration comes from below
constexpr double small = 1e-6;                   // of displacements, in radii
constexpr std::size_t most_particles = 100'000;  // beyond, a start would take many seconds

/// Of all particles, a column each.
using Vector = Eigen::Matrix<double, 3, Eigen::Dynamic>;

/// What the forces about rest do to small motions.
class NearRest {
 public:
  NearRest(const Body& body, const WorldLoad& world)
      : body_(body),
        world_(world),
        particles_(particles_at(body.rest, body.material.pair.r, body.material.mass)),
        at_rest_(rest_pose(body.skeleton)) {
    if (remembers_neighbours(body.material)) solid_.emplace(body.material, body.rest);
    bias_ = forces(Vector::Zero(3, particles_.size()), 0);
  }

  Eigen::Index size() const { return static_cast<Eigen::Index>(particles_.size()); }

  /// (dt^2 / 4 K + dt / 2 D) u / m
  Vector driven(const Vector& u, double dt) {
    const double mass = body_.material.mass;
    return (bias_ - forces(u, dt)) / mass +
           (dt * dt / 4 * world_.stiffness / mass + dt / 2 * world_.damping) * u;
  }

 private:
  Vector forces(const Vector& u, double dt) {
    for (std::size_t i = 0; i < particles_.size(); ++i) {
      particles_.set_position(i, body_.rest[i] + dt * dt / 4 * u.col(i));
      particles_.set_velocity(i, dt / 2 * u.col(i));
    }
    if (solid_)
      solid_->forces(particles_, forces_);
    else
      pair_forces(particles_, body_.material, forces_);
    bone_forces(particles_, body_, at_rest_, forces_);
    Vector all(3, particles_.size());
    for (std::size_t i = 0; i < particles_.size(); ++i) all.col(i) = forces_.total(i);
    return all;
  }

  const Body& body_;
  WorldLoad world_;
  Particles particles_;
  Pose at_rest_;
  std::optional<Solid> solid_;
  Forces forces_;
  Vector bias_;
};

Vector random_motion(Eigen::Index particles) {
  std::mt19937 random(1);
  Vector u(3, particles);
  for (double& value : u.reshaped()) value = static_cast<double>(random()) / 4294967296.0 - 0.5;
  return u;
}

}  // namespace

bool is_thin(const Points& rest, double radius) {
  const NeighbourLists near = neighbours_within(rest, rest_neighbour_range(radius));
  const auto covered = [&](std::size_t i) { return near.of(i).size() >= neighbours_inside; };
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const auto around = near.of(i);
    if (covered(i) && std::all_of(around.begin(), around.end(), covered)) return false;
  }
  return !rest.empty();
}

double power_step_limit(const Body& body, const WorldLoad& world) {
  NearRest near(body, world);
  Vector u = random_motion(near.size());
  double step = step_limit(Integrator::symplectic_euler, body.material, body.springs, world);
  const auto scaled = [&](const Vector& to) -> Vector {
    return small * body.material.pair.r / (step * step / 4) / to.cwiseAbs().maxCoeff() * to;
  };
  const auto share = [&](double dt) {
    return near.driven(u, dt).cwiseProduct(u).sum() / u.squaredNorm();
  };
  for (int round = 0; round < rounds; ++round) {
    for (int n = 0; n < iterations; ++n) {
      const Vector next = near.driven(u, step);
      if (!(next.cwiseAbs().maxCoeff() > 0)) return step;  // nothing holds the particles
      u = scaled(next);
    }
    // Of the mode found: a t^2 + b t for a step t times as long.
    const double whole = share(step), half = share(step / 2);
    const double a = 2 * whole - 4 * half, b = 4 * half - whole;
    step *= 2 / (b + std::sqrt(b * b + 4 * a));
  }
  return margin * step;
}

double step_limit(Integrator integrator, const Body& body, const WorldLoad& world) {
  const double limit = step_limit(integrator, body.material, body.springs, world);
  const PairForce& pair = body.material.pair;
  const bool linear =
      body.material.model != MaterialModel::paper || std::abs(pair.lambda() - 1) < 1e-3;
  if (integrator == Integrator::explicit_euler || !linear || body.rest.size() > most_particles ||
      !is_thin(body.rest, pair.r))
    return limit;
  return power_step_limit(body, world);
}

}  // namespace sinew

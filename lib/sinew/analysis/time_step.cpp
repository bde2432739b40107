// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/analysis/time_step.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <random>

#include <sinew/body/bone_force.h>
#include <sinew/body/solid.h>
#include <sinew/core/cell_grid.h>
#include <sinew/core/error.h>
#include <sinew/core/particles.h>
#include <sinew/core/text.h>

namespace sinew {

namespace {

bool is_central(const Material& material) { return acts_along_pairs(material.damping_form); }

/// A kind of mode that may become unstable first: decay rate by eq. 2, and squared frequency.
struct Mode {
  double rate;  // C / m
  double w2;    // k / m
};

/// Highest frequency of the packing, w^2 in k / m.
double lattice_factor(const Material& material) {
  return highest_frequency_factor(material.packing());
}

/// Inside the packing (exact), and at its surface, where fewer neighbors make the damping of eq. 2
/// stronger and the springs softer (the extremes found by power iteration on boxes and balls); but
/// `stiffest`, of BondFactors, where bonds make up for those that are missing.
std::array<Mode, 2> worst_modes(const Material& material, double stiffest) {
  const double w2 = lattice_factor(material);
  const double surface = material.bond.second > 0 ? std::max(w2, 2 * stiffest) : w2 * 5 / 8;
  if (is_central(material)) return {Mode{2.0 / 3, w2}, Mode{0.87, surface}};
  return {Mode{4.0 / 3, w2}, Mode{1.52, surface}};
}

double largest_damping(const std::vector<BoneSprings>& springs) {
  double most = 0;
  for (const BoneSprings& bone : springs) most = std::max(most, bone.damping);
  return most;
}

double stiffest_spring(const std::vector<BoneSprings>& springs) {
  double most = 0;
  for (const BoneSprings& bone : springs) most = std::max(most, bone.stiffest());
  return most;
}

double semi_implicit_limit(const Material& material, const std::vector<BoneSprings>& springs,
                           const WorldLoad& world, double stiffest) {
  double limit = std::numeric_limits<double>::infinity();
  for (const Mode& mode : worst_modes(material, stiffest)) {
    const double k = mode.w2 * material.stiffness() + stiffest_spring(springs) + world.stiffness;
    const double w2 = k / material.mass;
    const double g =
        (mode.rate * material.damping + largest_damping(springs)) / material.mass + world.damping;
    limit = std::min(limit, 4 / (std::sqrt(g * g + 4 * w2) + g));  // (sqrt(g^2 + 4 w^2) - g) / w^2
  }
  return limit;
}

double explicit_limit(const Material& material, const std::vector<BoneSprings>& springs,
                      const WorldLoad& world, double stiffest) {
  const double C = material.damping;
  const double factor = is_central(material) ? 1.5 : 1, k = material.stiffness();
  double w2 = 0;
  for (const Mode& mode : worst_modes(material, stiffest)) w2 = std::max(w2, mode.w2);
  double limit = C / (factor * w2 * k + factor * world.stiffness);
  for (const Mode& mode : worst_modes(material, stiffest))
    if (C > 0)
      limit = std::min(
          limit, 2 * material.mass /
                     (mode.rate * C + largest_damping(springs) + material.mass * world.damping));
  for (const BoneSprings& bone : springs)
    if (bone.stiffest() > 0) limit = std::min(limit, bone.damping / bone.stiffest());
  return limit;
}

}  // namespace

double explicit_step_for(const Body& body, const WorldLoad& world, double duration) {
  const Material material = lightest(body);
  double limit = std::numeric_limits<double>::infinity(), undamped = world.stiffness;  // N/m
  for (const BoneSprings& bone : body.springs)
    if (bone.damping > 0)
      limit = std::min(limit, bone.damping / bone.stiffest());
    else
      undamped = std::max(undamped, bone.stiffest());
  if (material.damping > 0)
    limit = std::min(limit, explicit_limit(material, {}, {}, body.factors.stiffest));
  else
    for (const Mode& mode : worst_modes(material, body.factors.stiffest))
      undamped = std::max(undamped, mode.w2 * material.stiffness());
  return undamped > 0 ? std::min(limit, 2 * material.mass / (undamped * duration)) : limit;
}

double stiffest_volume(const Body& body) {
  const Material& material = body.material;
  const PackingStiffness packing = material.packing();
  const double k_over_d0 = 2 * material.pair.k1 * material.relaxed * material.order;
  double most = 0;
  for (std::size_t i = 0; i < body.local.volume.size(); ++i) {
    const double relative = value_at(body.stiffness, i, 1);
    const double factor =
        highest_frequency_factor({packing.second, body.local.volume[i] / (relative * k_over_d0)});
    most = std::max(most, relative * factor / 2);  // w^2 is twice the stiffest
  }
  return most;
}

double step_limit(Integrator integrator, const Material& material,
                  const std::vector<BoneSprings>& springs, const WorldLoad& world,
                  double stiffest) {
  return integrator == Integrator::explicit_euler
             ? explicit_limit(material, springs, world, stiffest)
             : semi_implicit_limit(material, springs, world, stiffest);
}

StepChoice choose_step(std::optional<double> step, double factor, double limit, double interval) {
  if (!step && !(limit > 0))
    throw bad_input(
        "explicit_euler has no stable time step without damping",
        "set material.damping and binding.bone_damping above 0, or use symplectic_euler");
  const double wanted = step.value_or(factor * limit);
  // The tolerance keeps a step that divides the interval exactly.
  const double steps = std::ceil(interval / wanted * (1 - 1e-12));
  if (!(steps < 1e9))
    throw bad_input(
        "a frame would take " + three_digits(steps) + " steps",
        step ? "make solver.time_step longer or output.interval shorter"
             : "make output.interval shorter, or the material denser or softer: the stability "
               "limit is " +
                   three_digits(limit) + " s");
  StepChoice choice;
  choice.limit = limit;
  choice.per_frame = std::max(1, static_cast<int>(steps));
  choice.step = interval / choice.per_frame;
  return choice;
}

namespace {

constexpr std::size_t neighbors_inside = 12;
constexpr int rounds = 3, iterations = 120;  // the step is improved after each round
constexpr double margin = 0.99;              // the iteration converges from below
constexpr double smallness = 1e-6;           // size of displacements, in radii
constexpr std::size_t max_tried = 100'000;   // beyond, starting would take many seconds

/// Motions of all particles, a column each.
using Motions = Eigen::Matrix<double, 3, Eigen::Dynamic>;

/// The forces about rest, linearized for small motions.
class NearRest {
 public:
  NearRest(const Body& body, const WorldLoad& world)
      : body_(body),
        world_(world),
        particles_(particles_at(body.rest, body.material.pair.r, lightest(body).mass)),
        at_rest_(rest_pose(body.skeleton)) {
    if (remembers_neighbors(body.material))
      solid_.emplace(body.material, body.rest, particles_.id, body.factors, body.local);
    bias_ = forces(Motions::Zero(3, particles_.size()), 0);
  }

  Eigen::Index size() const { return static_cast<Eigen::Index>(particles_.size()); }

  /// (dt^2 / 4 K + dt / 2 D) u / m
  Motions driven(const Motions& u, double dt) {
    const double mass = particles_.mass;
    return (bias_ - forces(u, dt)) / mass +
           (dt * dt / 4 * world_.stiffness / mass + dt / 2 * world_.damping) * u;
  }

 private:
  Motions forces(const Motions& u, double dt) {
    for (std::size_t i = 0; i < particles_.size(); ++i) {
      particles_.set_position(i, body_.rest[i] + dt * dt / 4 * u.col(i));
      particles_.set_velocity(i, dt / 2 * u.col(i));
    }
    if (solid_)
      solid_->forces(particles_, forces_);
    else
      pair_forces(particles_, body_.material, forces_);
    bone_forces(particles_, body_, at_rest_, forces_);
    Motions all(3, particles_.size());
    for (std::size_t i = 0; i < particles_.size(); ++i) all.col(i) = forces_.total(i);
    return all;
  }

  const Body& body_;
  WorldLoad world_;
  Particles particles_;
  Pose at_rest_;
  std::optional<Solid> solid_;
  Forces forces_;
  Motions bias_;
};

Motions random_motion(Eigen::Index particles) {
  std::mt19937 random(1);
  Motions u(3, particles);
  for (double& value : u.reshaped()) value = static_cast<double>(random()) / 4294967296.0 - 0.5;
  return u;
}

}  // namespace

bool is_thin(const NeighborLists& near) {
  const auto covered = [&](std::size_t i) { return near.of(i).size() >= neighbors_inside; };
  for (std::size_t i = 0; i < near.size(); ++i) {
    const auto around = near.of(i);
    if (covered(i) && std::all_of(around.begin(), around.end(), covered)) return false;
  }
  return near.size() > 0;
}

double power_step_limit(const Body& body, const WorldLoad& world) {
  NearRest near(body, world);
  Motions u = random_motion(near.size());
  double step = step_limit(Integrator::symplectic_euler, lightest(body), body.springs, world,
                           body.factors.stiffest);
  const auto scaled = [&](const Motions& to) -> Motions {
    return smallness * body.material.pair.r / (step * step / 4) / to.cwiseAbs().maxCoeff() * to;
  };
  const auto fraction = [&](double dt) {
    return near.driven(u, dt).cwiseProduct(u).sum() / u.squaredNorm();
  };
  for (int round = 0; round < rounds; ++round) {
    for (int n = 0; n < iterations; ++n) {
      const Motions next = near.driven(u, step);
      if (!(next.cwiseAbs().maxCoeff() > 0)) return step;  // nothing holds the particles
      u = scaled(next);
    }
    // Fraction of the mode found: a t^2 + b t for a step t times as long.
    const double whole = fraction(step), half = fraction(step / 2);
    const double a = 2 * whole - 4 * half, b = 4 * half - whole;
    step *= 2 / (b + std::sqrt(b * b + 4 * a));
  }
  return margin * step;
}

double step_limit(Integrator integrator, const Body& body, const WorldLoad& world) {
  const double limit =
      step_limit(integrator, lightest(body), body.springs, world, body.factors.stiffest);
  const bool linear = law_of(body.material).is_linear_at_rest(body.material);
  if (integrator == Integrator::explicit_euler || !linear || body.rest.size() > max_tried ||
      !is_thin(neighbors_of(body)->nearest))
    return limit;
  return power_step_limit(body, world);
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// The creep rate of a scene that gives none. A bar that is pulled at a rate of strain e flows at
// the shear y + sqrt(3/2) e / creep_rate: the yield shear y, and the overstress of Bingham's solid.
#include <algorithm>
#include <cmath>

#include <sinew/rig/motion.h>
#include <sinew/scene/prepare.h>
#include <sinew/world/world.h>

namespace sinew {

namespace {

/// How fast obstacles move (m/s), and how fast bones, supports and obstacles turn (rad/s).
struct Rates {
  double speed = 0, turn = 0;
};

Rates rates_at(const World* world, double time, const Pose& pose) {
  Rates rates;
  for (const BonePose& bone : pose) rates.turn = std::max(rates.turn, bone.angular_velocity.norm());
  if (world == nullptr) return rates;
  const WorldNow now = world_at(*world, time, pose);
  for (const auto* moving : {&now.obstacles, &now.supports})
    for (const ObstaclePose& one : *moving) {
      rates.turn = std::max(rates.turn, one.angular_velocity.norm());
      rates.speed = std::max(rates.speed, one.velocity.norm());
    }
  return rates;
}

Rates largest_rates(const Prepared& prepared) {
  constexpr int samples = 8;  // per interval, as for the speeds of bones
  const FrameTimes& frames = prepared.frames;
  PoseCursor poses(prepared.body.skeleton, prepared.motion);
  Rates largest;
  for (int k = 0; k <= frames.count * samples; ++k) {
    const double time = std::min(k * frames.interval / samples, frames.end);
    const Rates now = rates_at(prepared.body.world.get(), time, poses.at(time));
    largest = {std::max(largest.speed, now.speed), std::max(largest.turn, now.turn)};
  }
  const auto thrown = [&](const BodyOptions& body) {
    largest.speed = std::max(largest.speed, body.velocity.norm());
    largest.turn = std::max(largest.turn, radians(body.angular_velocity.norm()));
  };
  thrown(prepared.settings.body);
  for (const PartOptions& part : prepared.settings.bodies) thrown(part.body);
  for (const double speed : prepared.bone_speeds) largest.speed = std::max(largest.speed, speed);
  return largest;
}

double largest_factor(const std::vector<ValueKeySettings>& keys) {
  double largest = keys.empty() ? 1 : 0;
  for (const ValueKeySettings& key : keys) largest = std::max(largest, std::abs(key.value));
  return largest;
}

/// An upper bound of the acceleration that gravity, fields, loads and muscles give to a body of
/// that mass (kg) and width (m), m/s^2.
double largest_acceleration(const Settings& settings, double mass, double width) {
  const double density = settings.material.density;
  const auto norm = [](const std::optional<Vec3>& of) { return of ? of->norm() : 0; };
  double sum = settings.solver.gravity.norm();
  for (const FieldSettings& field : settings.world.fields)
    sum += largest_factor(field.keys) * (norm(field.acceleration) + norm(field.density) / density +
                                         std::abs(field.strength.value_or(0)));
  for (const LoadSettings& load : settings.loads)
    sum += largest_factor(load.keys) *
           (norm(load.gravity) + norm(load.force) / mass +
            (norm(load.traction) + std::abs(load.pressure.value_or(0))) / (density * width));
  for (const MuscleSettings& muscle : settings.world.muscles)
    sum += largest_factor(muscle.keys) * muscle.strength / (density * width);
  return sum;
}

double min_yield(const Body& body) {
  const auto& local = body.local.yield;
  return local.empty() ? body.material.bond.yield_shear
                       : *std::min_element(local.begin(), local.end());
}

}  // namespace

double strain_rate(const Prepared& prepared) {
  const Body& body = prepared.body;
  const double width = bounds(body.rest).sizes().minCoeff() + 2 * body.material.pair.r;
  const double mass = body.material.mass * static_cast<double>(body.rest.size());
  const double acceleration = largest_acceleration(prepared.settings, mass, width);
  const Rates rates = largest_rates(prepared);
  return std::max({rates.turn, rates.speed / width, std::sqrt(2 * acceleration / width)});
}

namespace {

/// What an automatic rate aims at, of the yield stress; more of a step's strain flowing in it
/// overshoots.
constexpr double aimed_overstress = 0.02, max_crept = 0.5;

/// The rate at which strain rates lead to that overstress, 1/s.
double rate_for(const Prepared& prepared, double overstress) {
  return std::sqrt(1.5) * strain_rate(prepared) / (overstress * min_yield(prepared.body));
}

}  // namespace

double creep_rate_of(const Prepared& prepared) {
  constexpr double slowest = 1;  // 1/s
  const BondStrength& bond = prepared.body.material.bond;
  if (bond.yield_shear <= 0 || prepared.settings.material.creep_rate) return bond.creep_rate;
  // Equilibria have no time: each iteration takes all that exceeds the yield stress.
  if (prepared.settings.solver.method == Method::static_equilibrium) return 1 / prepared.steps.step;
  return std::min(std::max(slowest, rate_for(prepared, aimed_overstress)),
                  max_crept / prepared.steps.step);
}

double stress_above_yield(const Prepared& prepared) {
  const Settings& settings = prepared.settings;
  const BondStrength& bond = prepared.body.material.bond;
  if (bond.yield_shear <= 0 || settings.material.creep_rate ||
      settings.solver.method == Method::static_equilibrium)
    return 0;
  return rate_for(prepared, 1) / bond.creep_rate;
}

}  // namespace sinew

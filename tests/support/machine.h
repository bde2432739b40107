// SPDX-License-Identifier: GPL-3.0-or-later
// A small upright box of particles of 1 cm in a testing machine.
#pragma once

#include <functional>
#include <memory>

#include <sinew/scene/damping.h>
#include <sinew/scene/prepare.h>
#include <sinew/scene/rig.h>
#include <sinew/scene/world.h>
#include <sinew/world/world.h>

#include "support/world.h"

namespace sinew::machine {

inline constexpr double r = 0.01;

inline std::vector<std::uint32_t> ids_where(const Points& rest,
                                            const std::function<bool(const Vec3&)>& holds) {
  std::vector<std::uint32_t> ids;
  for (std::uint32_t i = 0; i < rest.size(); ++i)
    if (holds(rest[i])) ids.push_back(i);
  return ids;
}

/// Moves along at constant velocity and turns at a constant rate about its pivot.
inline ObstacleMotion moving(const Vec3& pivot, const Vec3& velocity,
                             const Vec3& spin = Vec3::Zero()) {
  return [=](double time, const Pose&) {
    const double rate = spin.norm();
    const Vec3 axis = rate > 0 ? Vec3(spin / rate) : Vec3(Vec3::UnitZ());
    return ObstaclePose{
        {pivot + time * velocity, Eigen::AngleAxisd(time * rate, axis).toRotationMatrix()},
        velocity,
        spin};
  };
}

class Machine {
 public:
  explicit Machine(MaterialModel model = MaterialModel::bonded, int height = 9)
      : rest(test::fcc_box(5, 5, height, r)), settings(test::unbound(test::box_scene(height))) {
    settings.material.model = model;
    settings.material.damping_form = DampingForm::central;
  }

  std::vector<std::uint32_t> bottom() const {
    return ids_where(rest, [](const Vec3& p) { return p.z() < r; });
  }
  std::vector<std::uint32_t> top() const {
    const double z = rest.back().z();
    return ids_where(rest, [z](const Vec3& p) { return p.z() > z - 0.5 * r; });
  }

  /// A force distributed equally over particles.
  Load pull(const std::vector<std::uint32_t>& on, const Vec3& force) const {
    return force_load("pull", on, std::vector<double>(on.size(), 1.0), force, rest);
  }

  /// Held by the world, with the damping ratio that it has there.
  Body body() const {
    Body body = make_body(settings, {}, skeleton_of(settings), test::particles_of(settings, rest));
    World made = world;
    hold(made, rest.size());
    body.world = std::make_shared<const World>(std::move(made));
    std::optional<ElasticModes> modes;
    set_damping(settings, body, modes);
    return body;
  }

  /// Iterations that bring it to rest at one moment after another.
  Simulation relaxing(LoadSteps steps) const {
    const Body made = undamped(body());
    const Particles particles = particles_at(rest, r, made.material.mass);
    const double limit = step_limit(Integrator::symplectic_euler, made, load_of(made));
    Simulation simulation(made, {}, particles,
                          stepping_of(settings.solver, relaxing_step_factor * limit));
    simulation.relax(std::move(steps));
    return simulation;
  }

  Simulation at_rest(LoadSteps steps = {}) const {
    Simulation simulation = relaxing(std::move(steps));
    while (!simulation.relaxation()->done()) simulation.step();
    return simulation;
  }

  Simulation begin() const {
    const Body made = body();
    return begin(made, particles_at(rest, r, made.material.mass));
  }
  Simulation begin(const Body& made, const Particles& particles) const {
    const double step =
        0.5 * step_limit(settings.solver.integrator, made.material, made.springs, load_of(made));
    return Simulation(made, {}, particles, stepping_of(settings.solver, step));
  }

  Simulation after(double duration) const {
    Simulation simulation = begin();
    while (simulation.time() < duration) simulation.step();
    return simulation;
  }

  /// The weight of all particles, N.
  Vec3 weight() const {
    return static_cast<double>(rest.size()) * test::material_of(settings).mass *
           settings.solver.gravity;
  }

  Points rest;
  Settings settings;
  World world;
};

inline Vec3 sum_of(const std::vector<Reaction>& reactions) {
  Vec3 sum = Vec3::Zero();
  for (const Reaction& one : reactions) sum += one.force;
  return sum;
}

/// Their moment about the origin of the scene, each acting at its pivot.
inline Vec3 moment_of(const std::vector<Reaction>& reactions, const Points& pivots) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 0; k < reactions.size(); ++k)
    sum += reactions[k].moment + pivots[k].cross(reactions[k].force);
  return sum;
}

}  // namespace sinew::machine

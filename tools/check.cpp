// SPDX-License-Identifier: GPL-3.0-or-later
// sinew-check: what a run would need, and what is doubtful in its scene, without running it.
#include <algorithm>
#include <cmath>

#include "command.h"
#include "config/scene.h"
#include "core/number_text.h"
#include "core/stopwatch.h"
#include "estimate.h"
#include "results.h"
#include "run_folder.h"
#include "scene_body.h"
#include "setup.h"

namespace {

using namespace sinew;

/// A doubt: the number, the reason and the cure in one line.
using Warnings = std::vector<std::string>;

// Beyond this the second neighbours, at 2.83 r, weaken the packing at rest: noise grows.
constexpr double largest_stable_b = 2.75;
constexpr double fastest_bone = 0.5;  // radii per step: more, and neighbours are passed, not pushed
constexpr double steepest_joint = 5;  // degrees between two planes: more, and bonds break

void warn_of_material(const Material& material, Warnings& warnings) {
  const PairForce& pair = material.pair;
  if (pair.b > largest_stable_b * pair.r)
    warnings.push_back("b is " + three_digits(pair.b / pair.r) +
                       " radii: second neighbours at 2.83 weaken the packing until it collapses by "
                       "itself; set material.b to 2.75 or less");
  if (pair.a > 2 * pair.r * (1 + 1e-9))
    warnings.push_back("a is " + three_digits(pair.a / pair.r) +
                       " radii: between 2 and a neighbours do not pull and a free body swells; set "
                       "material.a to 2");
}

void warn_of_step(const StepChoice& steps, Warnings& warnings) {
  if (steps.factor() > 1)
    warnings.push_back("the time step is " + three_digits(steps.factor()) +
                       " of the stability limit: the run will become unstable; use "
                       "solver.time_step " +
                       three_digits(steps.limit / 2) + " or auto");
  else if (steps.factor() > 0.9)
    warnings.push_back("the time step is " + three_digits(steps.factor()) +
                       " of the stability limit: bent joints rattle above 0.9; use auto");
}

void warn_of_speed(double speed, Warnings& warnings) {
  if (speed > fastest_bone)
    warnings.push_back("a bone moves " + three_digits(speed) +
                       " radii in a step: the body cannot follow; slow the motion down or shorten "
                       "solver.time_step");
}

double largest_twist(const Motion& motion) {
  double most = 0;
  for (const Track& track : motion.tracks)
    for (const Key& key : track.keys) most = std::max(most, std::abs(key.twist));
  return most;
}

void warn_of_cut(const Settings& settings, const Setup& setup, Warnings& warnings) {
  const double twist = degrees(largest_twist(setup.motion));
  if (settings.binding.joint_zone > 0 || twist < steepest_joint) return;
  warnings.push_back("a twist of " + three_digits(twist) +
                     " degrees would fall between two planes of particles and cut the body; set "
                     "binding.joint_zone to 3 and binding.twist_stiffness to 6.4");
}

void warn_of_bones(const Setup& setup, Warnings& warnings) {
  for (std::size_t b = 0; b < setup.body.skeleton.size(); ++b)
    if (!(setup.body.binding.cross_section[b] > 0))
      warnings.push_back("no particle follows bone '" + setup.body.skeleton.bones[b].name +
                         "'; move it into the body");
}

Warnings warnings_of(const Settings& settings, const Setup& setup, double speed) {
  Warnings warnings;
  warn_of_material(setup.body.material, warnings);
  warn_of_step(setup.steps, warnings);
  warn_of_speed(speed, warnings);
  warn_of_cut(settings, setup, warnings);
  warn_of_bones(setup, warnings);
  return warnings;
}

/// Seconds one step takes, tried out on the spot.
double seconds_per_step(const Settings& settings, const Setup& setup, const Particles& particles) {
  Simulation simulation = start(settings, setup, particles);
  simulation.step();
  Stopwatch watch;
  double spent = 0;
  int steps = 0;
  for (; steps < 20 && spent < 0.5; ++steps) {
    simulation.step();
    spent += watch.lap();
  }
  return spent / steps;
}

void add_sizes(const Filling& filling, const ClosedSurface& surface, Results& results) {
  const Particles& particles = filling.particles;
  results.add("particles", particles.size());
  results.add("radius", particles.radius, "m");
  results.add("surface_points", surface.triangles.points.size());
  results.add("surface_triangles", surface.triangles.faces.size());
  results.add("volume", filling.report.mesh_volume, "m^3");
  results.add("mass", particles.mass * static_cast<double>(particles.size()), "kg");
}

void add_material(const Material& material, Results& results) {
  const PairForce& pair = material.pair;
  const double k = pair.contact_stiffness();
  results.add("young_modulus", material.young_modulus(), "Pa");
  results.add("poisson_ratio", poisson_ratio_hill);
  results.add("bulk_modulus", 2 * std::sqrt(2.0) / 3 * k / (2 * pair.r), "Pa");
  results.add("k1", pair.k1, "Pa");
  results.add("k2", pair.k2, "Pa");
  results.add("contact_stiffness", k, "N/m");
  results.add("tension_stiffness", pair.tension_stiffness(), "N/m");
  results.add("lambda", pair.lambda());
  results.add("damping_constant", material.damping, "kg/s");
  results.add("wave_speed_100", 2 * pair.r * std::sqrt(k / material.mass), "m/s");
}

void add_steps(const Settings& settings, const Setup& setup, double speed, Results& results) {
  const auto limit_of = [&](Integrator integrator) {
    return step_limit(integrator, setup.body.material, setup.body.springs);
  };
  results.add("time_step_limit_symplectic_euler", limit_of(Integrator::symplectic_euler), "s");
  results.add("time_step_limit_explicit_euler", limit_of(Integrator::explicit_euler), "s");
  results.add("time_step", setup.steps.step, "s");
  results.add("time_step_factor", setup.steps.factor());
  results.add("steps_per_frame", setup.steps.per_frame);
  results.add("frames", setup.frames + 1);
  results.add("steps", static_cast<std::int64_t>(setup.frames) * setup.steps.per_frame);
  results.add("duration", settings.solver.duration, "s");
  results.add("bone_speed", speed, "radii per step");
}

Exit check(const std::string& scene, const Common& common) {
  const Settings settings = read_scene(scene, common.overrides);
  const ClosedSurface surface = read_mesh(settings);
  const Filling filling = fill_body(settings, surface);
  const Setup setup = set_up(settings, filling.particles);
  const Triangles& skin = surface.triangles;
  const Needs needs = needs_of(settings, setup, skin.points.size(), skin.faces.size());
  const double speed = bone_speed(setup, settings.output.interval);
  const double per_step = seconds_per_step(settings, setup, filling.particles);

  Results results;
  add_sizes(filling, surface, results);
  add_material(setup.body.material, results);
  add_steps(settings, setup, speed, results);
  results.add("disk", bytes_text(needs.disk));
  results.add("disk_free", bytes_text(free_space(run_folder(scene, "").path)));
  results.add("memory", bytes_text(needs.memory));
  results.add("stepping_time", per_step * setup.frames * setup.steps.per_frame, "s");
  const Warnings warnings = warnings_of(settings, setup, speed);
  results.add("warnings", warnings.size());
  results.print(common.json);
  for (const std::string& warning : warnings)
    std::fprintf(stderr, "sinew: warning: %s\n", warning.c_str());
  return Exit::done;
}

}  // namespace

int main(int argc, char** argv) {
  std::string scene;
  return run_command(
      argc, argv,
      {"check",
       "Says what a run would need, and what is doubtful in its scene.",
       {"sinew check configs/box_bend.yaml",
        "sinew check configs/box_bend.yaml --set body.radius=0.005"}},
      [&](CLI::App& app) { app.add_option("SCENE", scene, "Scene file (YAML)")->required(); },
      [&](const Common& common) { return check(scene, common); });
}

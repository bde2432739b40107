// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/inspection/check.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include <sinew/analysis/elastic_modes.h>
#include <sinew/analysis/spin.h>
#include <sinew/analysis/time_step.h>
#include <sinew/core/particles.h>
#include <sinew/core/system.h>
#include <sinew/core/text.h>
#include <sinew/groups/kept_free.h>
#include <sinew/io/series.h>
#include <sinew/scene/check/model_limits.h>
#include <sinew/scene/check/needs.h>
#include <sinew/scene/check/rest_trial.h>
#include <sinew/scene/check/stiffness.h>
#include <sinew/scene/check/warnings.h>
#include <sinew/scene/groups.h>
#include <sinew/scene/intrusions.h>
#include <sinew/scene/machine.h>
#include <sinew/scene/particle_parts.h>
#include <sinew/scene/rig.h>
#include <sinew/scene/steps.h>
#include <sinew/scene/world.h>

namespace sinew {
namespace {

constexpr int trials_of_small_bodies = 3;  // whose steps take so little that trials differ
constexpr std::size_t small_body = 50000, smallest_group = 64;  // particles

double initial_kinetic_energy(const Prepared& prepared) {
  Particles particles = prepared.filled.particles;
  set_initial_velocities(prepared.thrown, prepared.body, particles);
  double sum = 0;
  for (std::size_t i = 0; i < particles.size(); ++i)
    sum += mass_of(prepared.body, i, particles.mass) / 2 * particles.velocity(i).squaredNorm();
  return sum;
}

void add_sizes(const Prepared& prepared, Findings& results) {
  const Particles& particles = prepared.filled.particles;
  const Triangles& surface = prepared.surface.triangles;
  results.add("particles", particles.size());
  results.add("radius", particles.radius, "m");
  results.add("surface_points", surface.points.size());
  results.add("surface_triangles", surface.faces.size());
  results.add("volume", prepared.report->volume, "m^3");
  results.add("mass", particles.mass * static_cast<double>(particles.size()), "kg");
  if (!prepared.thrown.empty())
    results.add("initial_kinetic_energy", initial_kinetic_energy(prepared), "J");
}

/// How the body rings as it is held. `asked`: its damping ratio. Returns the shapes of its modes.
std::vector<Points> add_modes(const Body& body, std::optional<double> asked, int wanted,
                              Findings& results) {
  results.add("damping_constant", body.material.damping, "kg/s");
  // Bodies on bones are braked alike where these turn.
  if (const double time = spin_time(body); std::isfinite(time)) results.add("spin_time", time, "s");
  const ElasticModes modes = elastic_modes(body, wanted);
  if (modes.empty()) return {};
  results.add("lowest_frequency", modes.frequency() / (2 * pi), "Hz");
  results.add("held_by", held_by(body));
  const double rate = body.rigid_damping ? body.rigid_damping->rate : 0;
  if (rate > 0) results.add("damping_rate", rate, "1/s");
  const double ratio = modes.damping_ratio(body.material.damping, rate);
  const bool more = asked && ratio > 1.02 * *asked && modes.damping_ratio(0) > *asked;
  results.add("damping_ratio", ratio,
              more ? "by binding.bone_damping, " + three_digits(*asked) + " asked" : "");
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (std::size_t n = 0; n < modes.shapes.size(); ++n) {
    const double frequency = std::sqrt(modes.squared[static_cast<Eigen::Index>(n)]) / (2 * pi);
    all.push_back({{"frequency", frequency}, {"held_by", held_by(body)}});
    if (wanted > 1) results.add_line("mode_" + std::to_string(n + 1), frequency, "Hz");
  }
  results.add_value("modes", all);
  return modes.shapes;
}

void add_material(const Material& material, Findings& results) {
  const PairForce& pair = material.pair;
  const double k = pair.contact_stiffness();
  results.add("young_modulus", material.young_modulus(), "Pa");
  results.add("poisson_ratio", material.constants().hill_poisson_ratio());
  results.add("bulk_modulus", material.constants().bulk_modulus(), "Pa");
  if (material.bond.breaking_strain > 0)
    results.add("breaking_strain", material.bond.breaking_strain);
  if (material.bond.yield_shear > 0) results.add("creep_rate", material.bond.creep_rate, "1/s");
  results.add("k1", pair.k1, "Pa");
  results.add("k2", pair.k2, "Pa");
  results.add("contact_stiffness", k, "N/m");
  results.add("tension_stiffness", pair.tension_stiffness(), "N/m");
  results.add("lambda", pair.lambda());
  const double density = material.mass / volume_per_particle(pair.r);
  results.add("wave_speed_100", std::sqrt(material.constants().C11 / density), "m/s");
  results.add("shear_wave_speed_100", std::sqrt(material.constants().C44 / density), "m/s");
}

void add_rest(const RestTrial& trial, Findings& results) {
  results.add_line("rest", text_of(trial));
  results.add_value("rest", name_of(trial.state));
  if (trial.particles == 0) return;
  results.add("rest_shift", trial.shift, "radii");
  results.add("rest_time", trial.time, "s");
  results.add("rest_particles", trial.particles);
}

/// Adds results of each bone, and of that along which the body is softest against the request.
void add_planes(const Body& body, Findings& results) {
  const auto bones = stiffness_along_bones(body);
  if (bones.empty()) return;
  const BoneStiffness& softest = *std::min_element(
      bones.begin(), bones.end(),
      [](const auto& a, const auto& b) { return a.bending_modulus() < b.bending_modulus(); });
  auto all = nlohmann::ordered_json::array();
  for (const BoneStiffness& bone : bones) {
    results.add_line("along_bone",
                     bone.bone + ", bends with " + quantity_text(bone.bending_modulus(), "Pa") +
                         ": " + parts_of_modulus(bone.young_modulus, bone.lack, bone.planes));
    all.push_back({{"bone", bone.bone},
                   {"young_modulus", bone.young_modulus},
                   {"planes_across", bone.planes},
                   {"lack_of_bending_stiffness", 100 * bone.lack}});
  }
  results.add_value("along_bones", std::move(all));
  results.add("softest_bone", softest.bone);
  results.add("young_modulus_along_it", softest.young_modulus, "Pa");
  results.add("planes_across", softest.planes);
  results.add("lack_of_bending_stiffness", 100 * softest.lack, "%");
}

/// Adds results between supports and loads.
void add_spans(const Prepared& prepared, Findings& results) {
  auto all = nlohmann::ordered_json::array();
  for (const SpanStiffness& span : stiffness_between_grips(prepared)) {
    results.add_line("along_span",
                     span.from + " to " + span.to + (span.bends ? ", bends" : ", is pulled") +
                         " with " + quantity_text(span.shown_modulus(), "Pa") + ": " +
                         parts_of_modulus(span.young_modulus, span.lack_shown(), span.planes));
    all.push_back({{"from", span.from},
                   {"to", span.to},
                   {"bends", span.bends},
                   {"young_modulus", span.young_modulus},
                   {"planes_across", span.planes},
                   {"shown_modulus", span.shown_modulus()}});
  }
  if (!all.empty()) results.add_value("along_spans", std::move(all));
}

/// Adds the faces that supports and loads on the surface take, by the axis next to their normals.
void add_faces(const Prepared& prepared, Findings& results) {
  const ParticleParts parts(prepared.settings, prepared.body, prepared.surface.triangles,
                            prepared.filled.component);
  auto all = nlohmann::ordered_json::array();
  const auto add = [&](const std::string& name, const PartSettings& part, const std::string& path) {
    const Triangles faces = parts.faces(part, path);
    std::map<std::string, double> area_by_axis;
    double sum = 0;
    for (const auto& face : faces.faces) {
      const Vec3 area = area_vector(faces, face);
      Eigen::Index axis = 0;
      area.cwiseAbs().maxCoeff(&axis);
      area_by_axis[std::string(area[axis] < 0 ? "-" : "+") + "xyz"[axis]] += area.norm();
      sum += area.norm();
    }
    std::string shares;
    auto along = nlohmann::ordered_json::object();
    for (const auto& [axis, area] : area_by_axis) {
      shares +=
          (shares.empty() ? ": " : ", ") + three_digits(100 * area / sum) + " % along " + axis;
      along[axis] = area;
    }
    results.add_line("faces_of_part", name + ", " + std::to_string(faces.faces.size()) +
                                          " faces, " + three_digits(sum) + " m^2" + shares);
    all.push_back({{"part", name}, {"faces", faces.faces.size()}, {"area_along", along}});
  };
  const Settings& settings = prepared.settings;
  for (std::size_t k = 0; k < settings.supports.size(); ++k)
    if (const auto& one = settings.supports[k]; one.part.faces())
      add(one.name, one.part, path_of_one("supports", k));
  for (std::size_t k = 0; k < settings.loads.size(); ++k)
    if (const auto& one = settings.loads[k]; one.pressure || one.traction || one.part.faces())
      add(one.name, one.part, path_of_one("loads", k));
  if (!all.empty()) results.add_value("faces_of_parts", std::move(all));
}

/// What the flesh of bones that stretch reaches from end to end.
void add_stretches(const Prepared& prepared, Findings& results) {
  for (const Track& track : prepared.motion.tracks) {
    const Bone& bone = prepared.body.skeleton.bones[track.bone];
    const double r = prepared.body.material.pair.r;
    const double held = std::max(0.0, 1 - 2 * stretch_lag(bone, r) / bone.length);
    double farthest = 1;
    for (const double factor : track.stretch.values)
      if (std::abs(factor - 1) > std::abs(farthest - 1)) farthest = factor;
    if (track.stretches())
      results.add_line("stretched_bone",
                       bone.name + ", by " + three_digits(farthest) + ": its flesh by " +
                           three_digits(1 + held * (farthest - 1)) + ", whose ends lag behind");
  }
}

/// Flesh that the motion drives into other flesh.
void add_intrusions(const Prepared& prepared, std::span<const Intrusion> found, Findings& results) {
  constexpr std::size_t max_lines = 8;
  const double r = prepared.body.material.pair.r;
  auto all = nlohmann::ordered_json::array();
  for (const Intrusion& one : found) {
    const auto name = [&](int bone) {
      return prepared.body.skeleton.bones[static_cast<std::size_t>(bone)].name;
    };
    const bool passes = prepared.body.pass_through.between(one.bones[0], one.bones[1]);
    if (all.size() < max_lines)
      results.add_line("flesh_meets", name(one.bones[0]) + " and " + name(one.bones[1]) + ", " +
                                          three_digits(one.depth / r) + " r deep at " +
                                          three_digits(one.deepest) + " s, first at " +
                                          three_digits(one.first) + " s" +
                                          (passes ? "; passes through" : ""));
    all.push_back({{"bones", {name(one.bones[0]), name(one.bones[1])}},
                   {"depth", one.depth / r},
                   {"first", one.first},
                   {"deepest", one.deepest},
                   {"passes_through", passes}});
  }
  if (found.size() > max_lines)
    results.add_line("flesh_meets", std::to_string(found.size() - max_lines) +
                                        " more pairs of bones, which --json lists");
  results.add_value("intrusions", std::move(all));
}

void add_steps(const Prepared& prepared, double speed, Findings& results) {
  const auto limit_of = [&](Integrator integrator) {
    return step_limit(integrator, prepared.body, load_of(prepared.body));
  };
  results.add("time_step_limit_symplectic_euler", limit_of(Integrator::symplectic_euler), "s");
  const double explicit_limit = limit_of(Integrator::explicit_euler);
  if (explicit_limit > 0)
    results.add("time_step_limit_explicit_euler", explicit_limit, "s");
  else
    results.add("time_step_limit_explicit_euler", "none: no step is stable without damping");
  results.add("time_step", prepared.steps.step, "s");
  results.add("time_step_factor", prepared.steps.factor());
  results.add("steps_per_frame", prepared.steps.per_frame);
  results.add("frames", prepared.frames.count + 1);
  results.add("steps", prepared.plan.steps_until(prepared.frames.count));
  if (prepared.plan.divided() > 0) {
    results.add("intervals_of_shorter_steps", prepared.plan.divided());
    results.add("shortest_time_step", prepared.steps.step / prepared.plan.max_parts(), "s");
  }
  results.add("duration", prepared.settings.solver.duration, "s");
  results.add("bone_speed", speed, "radii per step");
}

/// Adds results of equilibria. The number of iterations is that of a body held at one end, which
/// is at rest only after its slowest motion.
void add_load_steps(const Prepared& prepared, double rate, Findings& results) {
  const LoadSteps& steps = *prepared.load_steps;
  const auto particles = static_cast<double>(prepared.filled.particles.size());
  results.add("method", "static");
  results.add("frames", steps.count);
  results.add("duration", prepared.settings.solver.duration, "s");
  results.add("residual", steps.residual);
  const bool newton = steps.solver == StaticSolver::newton;
  results.add("static_solver", newton ? "newton" : "relaxation");
  if (newton) results.add("factor_nonzeros", steps.cost.nonzeros);
  results.add("max_iterations_per_frame", steps.max_iterations);
  if (newton) return;
  results.add("foreseen_iterations_per_frame", steps.cost.iterations);
  results.add("time_of_1000_iterations", 1000 * particles / rate, "s");
}

/// What groups that stay bring a body at rest: trials with them and without.
void add_groups(const Prepared& prepared, Findings& results, std::vector<std::string>& warnings) {
  const auto sizes = group_sizes(prepared.settings, prepared.body, prepared.motion);
  if (!sizes) return;
  const auto best_speed = [&](const std::shared_ptr<const Grouping>& grouping) {
    Prepared tried = prepared;
    tried.body.grouping = grouping, tried.dynamic_groups.reset();
    double best = 0;
    const int trials = tried.body.rest.size() < small_body ? trials_of_small_bodies : 1;
    for (int trial = 0; trial < trials; ++trial)
      best = std::max(best, speed_at_rest(tried, warnings));
    return best;
  };
  const auto grouping_of = [&](const GroupSizes& wanted) {
    return groups_that_stay(prepared.settings, prepared.body, prepared.motion, wanted);
  };
  std::shared_ptr<const Grouping> grouping = grouping_of(*sizes);
  results.add("groups", grouping->size());
  const auto percent = [&](std::size_t count) {
    return 100 * static_cast<double>(count) / static_cast<double>(prepared.body.rest.size());
  };
  results.add("grouped", percent(grouping->grouped()), "%");
  if (const auto near =
          near_obstacles(prepared.body, prepared.motion, prepared.settings.solver.duration);
      !near.empty())
    results.add("free_near_obstacles", std::count(near.begin(), near.end(), 1), "particles");
  results.add("within_groups", percent(grouping->inside()), "%");
  if (grouping->size() == 0) {  // too small: what groups of any size would bring
    GroupSizes small = *sizes;
    small.min_particles = smallest_group;
    grouping = grouping_of(small);
  }
  if (grouping->size() == 0) return;
  const double time_ratio = best_speed(nullptr) / best_speed(grouping);
  results.add("faster_by_groups_at_rest", 1 / time_ratio);
  results.add("groups_pay_from", groups_pay_from(*grouping, *sizes, time_ratio), "particles");
}

void add_stepper(const StepperChoice& choice, Findings& results) {
  results.add("precision", name_of(choice.precision));
  results.add("neighbor_search", name_of(choice.search));
  results.add("instruction_set", kernel::name_of(choice.instructions));
}

}  // namespace

SceneCheck check_scene(const Prepared& prepared, const std::filesystem::path& folder, int modes) {
  SceneCheck check;
  Findings& results = check.findings;
  const Needs needs = needs_of(prepared);
  const StepperChoice choice = stepper_choice(prepared.settings.solver);
  const double speed = farthest_carried(prepared);
  check.warnings = warnings_before_trials(prepared, speed);
  const double at_rest = speed_at_rest(prepared, check.warnings);
  const double rate = speed_in_motion(prepared, at_rest);
  const double work = static_cast<double>(prepared.plan.steps_until(prepared.frames.count)) *
                      static_cast<double>(prepared.filled.particles.size());
  add_sizes(prepared, results);
  add_material(prepared.body.material, results);
  const RestTrial rest = try_rest(prepared);
  if (const std::string warning = warning_of(rest); !warning.empty())
    check.warnings.push_back(warning);
  add_rest(rest, results);
  check.shapes = add_modes(
      prepared.body, prepared.load_steps ? std::nullopt : prepared.settings.material.damping_ratio,
      modes, results);
  add_planes(prepared.body, results);
  add_spans(prepared, results);
  add_faces(prepared, results);
  for (const ModelLimit& limit : model_limits(prepared))
    results.add(limit.key, limit.value, limit.text);
  add_stretches(prepared, results);
  check.meeting = intrusions_of(prepared);
  add_intrusions(prepared, check.meeting, results);
  if (prepared.load_steps)
    add_load_steps(prepared, rate, results);
  else
    add_steps(prepared, speed, results);
  add_groups(prepared, results, check.warnings);
  add_stepper(choice, results);
  const std::uint64_t free = free_space(folder);
  for (const auto& [key, bytes] :
       {std::pair("disk", needs.disk), {"disk_free", free}, {"memory", needs.memory}})
    results.add(key, bytes_text(static_cast<double>(bytes)));
  results.add("particle_steps_per_second", rate);
  if (!prepared.load_steps) results.add("stepping_time", work / rate, "s");
  shortest_first(check.warnings);
  return check;
}

void write_modes(const Prepared& prepared, const std::vector<Points>& shapes,
                 const std::filesystem::path& path) {
  constexpr int frames = 12;
  const Points& rest = prepared.body.rest;
  const double size = bounds(rest).sizes().maxCoeff() / 10;
  Series series(path.parent_path().empty() ? "." : path.parent_path(),
                {.series = path.stem().string(), .radius = prepared.body.material.pair.r});
  for (int k = 0; k < frames; ++k) {
    Dataset frame;
    frame.time = static_cast<double>(k) / frames;
    frame.points = rest;
    frame.connectivity = vertex_cells(rest.size());
    for (std::size_t n = 0; n < shapes.size(); ++n) {
      Points moved = shapes[n];
      for (Vec3& u : moved) u *= size * std::sin(2 * pi * frame.time);
      frame.point_columns.push_back(column("mode_" + std::to_string(n + 1), moved));
    }
    series.add(frame);
  }
  series.close();
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/prepare.h>

#include <algorithm>
#include <cmath>

#include <sinew/analysis/free_motion.h>
#include <sinew/core/error.h>
#include <sinew/core/system.h>
#include <sinew/core/text.h>
#include <sinew/repair/read_surface.h>
#include <sinew/rig/motion.h>
#include <sinew/scene/bind_scene.h>
#include <sinew/scene/body_mesh.h>
#include <sinew/scene/context.h>
#include <sinew/scene/damping.h>
#include <sinew/scene/filling.h>
#include <sinew/scene/first_pose.h>
#include <sinew/scene/frame_content.h>
#include <sinew/scene/groups.h>
#include <sinew/scene/initial_velocities.h>
#include <sinew/scene/particle_parts.h>
#include <sinew/scene/rig.h>
#include <sinew/scene/rigid_parts.h>
#include <sinew/scene/steps.h>
#include <sinew/scene/world.h>
#include <sinew/settings/read_scene.h>

namespace sinew {

namespace {

bool is_static(const Settings& settings) {
  return settings.solver.method == Method::static_equilibrium;
}

constexpr double max_steps = 2e9;  // files count them in 32 bits

/// Returns warnings only once for a rig that gives both bones and motion.
std::vector<std::string> warnings_of(const SceneFiles& files) {
  std::vector<std::string> warnings = files.skeleton.rig.warnings;
  if (files.motion.warnings != warnings)
    warnings.insert(warnings.end(), files.motion.warnings.begin(), files.motion.warnings.end());
  return warnings;
}

}  // namespace

namespace {

/// The pairs that the scene names.
PassThrough named_passing(const Settings& settings, const Skeleton& skeleton) {
  const std::string key = "contact.pass_through";
  std::vector<PassThrough::Pair> pairs;
  for (const auto& [a, b] : settings.contact.pass_through.pairs) {
    if (a == b)
      throw bad_input(settings.place(key), "bone " + shown(a) + " is paired with itself",
                      "name two bones");
    pairs.push_back({bone_of(settings, key, skeleton, a), bone_of(settings, key, skeleton, b)});
  }
  return {skeleton.size(), pairs};
}

}  // namespace

Material material_of(const Settings& settings, const Particles& particles) {
  MaterialOptions options = settings.material;
  // Groups that bend rest on eq. 2, which is zero within them.
  if (settings.hierarchy.enabled && !options.damping_form)
    options.damping_form = DampingForm::paper;
  Material material = make_material(options, {particles.radius, particles.mass,
                                              lattice_axes(settings.body), settings.body.packing});
  for (const LocalMaterialSettings& local : settings.materials) {
    BondStrength& bond = material.bond;
    if (local.breaking_strain && bond.breaking_strain == 0) bond.breaking_strain = never_reached;
    if (local.yield_strain && bond.yield_shear == 0) bond.yield_shear = never_reached;
  }
  return is_static(settings) ? long_term(material) : material;
}

LocalMaterial local_material(const BodyFile& body) {
  const auto given = [](const auto& values) { return values.value_or(std::vector<double>()); };
  return {given(body.volume_share), given(body.stiffness), body.component};
}

Body make_body(const Settings& settings, const SceneFiles& files, Skeleton skeleton,
               const Particles& particles, LocalMaterial local, const ForceLaw* law) {
  Body body;
  body.rest = positions_of(particles);
  body.skeleton = std::move(skeleton);
  body.material = material_of(settings, particles);
  body.material.law = law;
  body.neighbors = neighbors_of(body);
  body.binding = bind_scene(settings, files, body.skeleton, body.rest, body.neighbors->nearest,
                            particles.radius);
  body.lattice = lattice_axes(settings.body);
  body.volume_share = std::move(local.volume_share);
  body.stiffness = std::move(local.stiffness);
  set_local_materials(settings, ParticleParts(settings, body, files.surface, local.component),
                      body);
  body.factors = bond_factors(body.rest, *body.neighbors, body.material, body.volume_share,
                              body.stiffness, body.local.volume);
  body.factors.stiffest = std::max(body.factors.stiffest, stiffest_volume(body));
  body.springs = bone_springs(settings.binding, body.material, body.binding, body.skeleton);
  body.pass_through = named_passing(settings, body.skeleton);
  return body;
}

namespace {

/// Packings that are no lattice rest on bonds of the lengths that they happen to have.
void check_packing(const Settings& settings) {
  if (is_lattice(settings.body.packing)) return;
  if (!has_bonds(settings.material.model))
    throw bad_input(settings.place("body.packing"),
                    "the paper's forces keep particles 2 radii apart, as only closest packings are",
                    "set material.model to bonded or bonded_volume, or body.packing to fcc");
  if (!settings.material.isotropic.value_or(true))
    throw bad_input(settings.place("material.isotropic"),
                    "only a lattice can have bonds of nearest neighbors alone",
                    "remove it, or set body.packing to fcc");
}

/// A body in equilibrium is restrained.
void refuse_free(const Settings& settings, const Body& body) {
  const auto free = free_motion(body);
  if (!free) return;
  throw bad_input(settings.place("solver.method"),
                  "no equilibrium: " + free->text() + ", and nothing holds it",
                  "add supports, pins or bones that do, or set solver.method to dynamic");
}

/// Groups that stay, or sizes of those that change.
void set_groups(Prepared& prepared) {
  const auto sizes = group_sizes(prepared.settings, prepared.body, prepared.motion);
  if (!sizes) return;
  if (prepared.settings.hierarchy.dynamic)
    prepared.dynamic_groups = {*sizes, prepared.settings.hierarchy.tolerance,
                               prepared.body.neighbors};
  else
    prepared.body.grouping =
        groups_that_stay(prepared.settings, prepared.body, prepared.motion, *sizes);
}

/// Chooses the bones whose flesh passes through each other.
void let_pass(Prepared& prepared) {
  Body& body = prepared.body;
  if (prepared.settings.contact.pass_through.automatic) {
    std::vector<PassThrough::Pair> pairs;
    for (const Intrusion& one : intrusions_of(prepared)) {
      if (one.depth <= passing_depth * body.material.pair.r) continue;
      prepared.passing.push_back(one);
      pairs.push_back(one.bones);
    }
    body.pass_through = PassThrough(body.skeleton.size(), pairs);
  } else {
    for (const PassThrough::Pair& pair : body.pass_through.pairs())
      prepared.passing.push_back({pair});
  }
}

/// Binds the particles to the bones, in their world.
void bind(const SceneFiles& files, const Scene& scene, Prepared& prepared) {
  const Settings& settings = prepared.settings;
  SceneRig rig = scene.with_rig ? rig_of(settings, files) : SceneRig{};
  prepared.body = make_body(settings, files, std::move(rig.skeleton), prepared.filled.particles,
                            local_material(prepared.filled), scene.law);
  SceneWorld around = world_of(settings, files, prepared.body, prepared.filled.component);
  prepared.body.world = std::move(around.world);
  hold_rigid_parts(settings.binding, prepared.body);
  prepared.obstacles = std::move(around.obstacles);
  prepared.probes = std::move(around.probes);
  prepared.motion = std::move(rig.motion);
  hold_stretched(prepared.motion, prepared.body.skeleton, prepared.body.material,
                 prepared.body.springs);
  prepared.thrown = thrown_parts(settings, prepared.surface, prepared.body.rest);
  prepared.beginning = begin_of(settings, prepared.body, prepared.motion);
  prepared.file_warnings = settings.warnings;
  for (const std::string& warning : warnings_of(files)) prepared.file_warnings.push_back(warning);
  prepared.joint_zone = settings.binding.joint_zone;
  prepared.weights_given = settings.binding.method == BindMethod::file;
  set_damping(settings, prepared.body, prepared.modes);
  let_pass(prepared);
  set_groups(prepared);
  if (!is_static(settings)) return;
  refuse_free(settings, prepared.body);
  prepared.body = undamped(std::move(prepared.body));
}

/// Chooses the step, and plans the run.
void plan(Prepared& prepared) {
  const Settings& settings = prepared.settings;
  prepared.steps = steps_of(settings, prepared.body);
  prepared.bone_speeds = bone_speeds(prepared);
  prepared.body.material.bond.creep_rate = creep_rate_of(prepared);
  prepared.plan = plan_of(settings, prepared);
  if (is_static(settings)) prepared.load_steps = load_steps_of(settings, prepared);
  if (settings.output.region)
    with_context(settings, "output.region", [&] {
      written_particles(settings.output, prepared.body.rest, prepared.body.material.pair.r,
                        prepared.body.neighbors);
    });
  if (static_cast<double>(prepared.plan.steps_until(prepared.frames.count)) > max_steps)
    throw bad_input(settings.place("solver.duration"), "the run would take over 2e9 steps",
                    "make solver.duration shorter or solver.time_step longer");
}

/// What binding tells of the particles.
void complete(const Body& body, BodyFile& filled) {
  if (!body.stiffness.empty()) filled.stiffness = body.stiffness;
  if (!body.density.empty()) filled.density = body.density;
  if (!body.local.volume.empty()) filled.volume_stiffness = body.local.volume;
  filled.bone = bones_of_particles(body);
  filled.weight = weights_of_particles(body);
}

}  // namespace

Prepared prepare(Scene scene) {
  Stopwatch watch;
  check_packing(scene.settings);
  check_features(scene.settings);
  Prepared prepared;
  prepared.settings = with_fit(scene.settings);
  const Settings& settings = prepared.settings;
  if (scene.with_surface || !scene.filled) prepared.surface = read_mesh(settings);
  if (scene.with_surface && settings.output.export_surface)
    prepared.look = look_of_mesh(settings, prepared.surface.triangles);
  SceneFiles files = read_files(settings);
  files.surface = prepared.surface.triangles;
  if (scene.filled) {
    prepared.filled = *std::move(scene.filled);
  } else {
    Filling filling = fill_body(settings, prepared.surface);
    prepared.report = filling.report;
    prepared.filled = body_file(std::move(filling), origin_of(settings));
  }
  prepared.seconds_filling = watch.lap();
  prepared.frames = frame_times(settings);
  prepared.modes = std::move(scene.modes);
  bind(files, scene, prepared);
  plan(prepared);
  complete(prepared.body, prepared.filled);
  prepared.seconds_binding = watch.lap();
  return prepared;
}

Simulation start(const Prepared& prepared) { return start(Prepared(prepared)); }

Simulation start(Prepared&& prepared, const RelaxationProgress& progress) {
  if (prepared.beginning.posed && !prepared.motion.tracks.empty())
    prepared.filled.particles = posed(prepared.body, prepared.motion, prepared.filled.particles,
                                      prepared.settings.solver, progress);
  set_initial_velocities(prepared.thrown, prepared.body, prepared.filled.particles);
  prepared.body.neighbors.reset();  // stepping has lists of its own
  Simulation simulation(std::move(prepared.body), std::move(prepared.motion),
                        std::move(prepared.filled.particles),
                        stepping_of(prepared.settings.solver, prepared.steps.step));
  if (prepared.load_steps)
    simulation.relax(*std::move(prepared.load_steps));
  else
    simulation.follow(std::move(prepared.plan));
  if (prepared.dynamic_groups) simulation.enable_dynamic_groups(*prepared.dynamic_groups);
  return simulation;
}

std::vector<Intrusion> intrusions_of(const Prepared& prepared) {
  constexpr double max_places = 5e7;  // particles at moments, some seconds: else some frames
  const double places =
      static_cast<double>(prepared.body.rest.size()) * (prepared.frames.count + 1.0);
  const int every = 1 + static_cast<int>(places / max_places);
  std::vector<double> times;
  for (int frame = 0; frame <= prepared.frames.count; frame += every)
    times.push_back(prepared.frames.at(frame));
  return intrusions(prepared.body, prepared.motion, times);
}

std::vector<std::int32_t> bones_of_particles(const Body& body) {
  std::vector<std::int32_t> bones(body.rest.size());
  for (std::size_t i = 0; i < bones.size(); ++i) bones[i] = body.binding.bone(i);
  return bones;
}

std::vector<double> weights_of_particles(const Body& body) {
  std::vector<double> weights(body.rest.size());
  for (std::size_t i = 0; i < weights.size(); ++i) weights[i] = body.binding.weight(i);
  return weights;
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/settings/sections.h>

#include <array>
#include <string>

#include <sinew/core/arrays.h>
#include <sinew/settings/read_scene.h>
#include <sinew/settings/settings.h>
#include <sinew/settings/table.h>

namespace sinew {
namespace {

/// Whether the scene gives this key a value (auto is none).
bool is_given(const Settings& settings, std::string_view path) {
  if (settings.places.find(path) == settings.places.end()) return false;
  for (const auto& row : settings_table())
    if (std::string(row.section) + '.' + std::string(row.name) == path)
      return !std::holds_alternative<std::monostate>(row.get(settings));
  return false;
}

void check_pair(const Settings& settings, const EitherOr& pair) {
  const bool first = is_given(settings, pair.first), second = is_given(settings, pair.second);
  const std::string names = std::string(pair.first) + " and " + std::string(pair.second);
  if (first && second)
    throw bad_input(settings.place(std::string(pair.second)), names + " are both given",
                    "keep one of them");
  if (pair.needed && !first && !second)
    throw bad_input(settings.place(std::string(pair.first)), names + " are both missing",
                    "give one of them");
}

/// The place of the first of two keys that the scene gives.
Place place_of(const Settings& settings, const char* first, const char* second) {
  return settings.place(is_given(settings, first) ? first : second);
}

void check_isotropy(const Settings& settings) {
  const MaterialOptions& material = settings.material;
  if (keeps_volume(material.model) && !is_isotropic(material, settings.body.packing) &&
      (material.poisson_ratio < 0.26 || material.poisson_ratio > 0.45))
    throw bad_input(settings.place("material.poisson_ratio"),
                    "twelve bonds a particle reach Poisson's ratios from 0.26 to 0.45, not " +
                        number_text(material.poisson_ratio),
                    "give one between, or set material.isotropic to true");
}

/// Branches of bonds that relax.
void check_relaxation(const Settings& settings) {
  const auto& ratios = settings.material.relaxation_shares;
  const auto& times = settings.material.relaxation_times;
  if (!ratios && !times) return;
  const Place place = place_of(settings, "material.relaxation_shares", "material.relaxation_times");
  const std::size_t count = ratios ? ratios->size() : 0;
  if (count != (times ? times->size() : 0))
    throw bad_input(place, "relaxation_shares and relaxation_times are not of one length",
                    "give a time for each share");
  if (count == 0 || count > max_relaxation_branches)
    throw bad_input(place,
                    "a bond has one to four branches that relax, not " + std::to_string(count),
                    "give fewer shares and times");
  double sum = 0;
  for (const double ratio : *ratios) sum += ratio;
  if (!(sum < 1))
    throw bad_input(place,
                    "the shares that relax come to " + number_text(sum) + ", and leave nothing",
                    "give shares whose sum is below 1");
}

void check_rayleigh(const Settings& settings) {
  const auto& given = settings.material.rayleigh;
  if (!given) return;
  const Place place = settings.place("material.rayleigh");
  if (given->size() != 2)
    throw bad_input(place, "Rayleigh's damping has two constants",
                    "give [alpha, beta] in 1/s and s");
  const MaterialOptions& material = settings.material;
  const bool ratio = material.damping_ratio.has_value();
  if (ratio || material.damping != MaterialOptions().damping)
    throw bad_input(place,
                    std::string("material.rayleigh sets the damping, as ") +
                        (ratio ? "material.damping_ratio does" : "material.damping does"),
                    "remove one of the two");
  const DampingForm by_default =
      has_bonds(material.model) ? DampingForm::rigid : DampingForm::paper;
  if (material.damping_form.value_or(by_default) != DampingForm::rigid)
    throw bad_input(place, "material.rayleigh is for damping_form rigid",
                    "set material.model to bonded or bonded_volume, and remove damping_form");
}

void check_material(const Settings& settings) {
  check_relaxation(settings);
  check_rayleigh(settings);
  const MaterialOptions& material = settings.material;
  if (!(material.a < material.b))
    throw bad_input(place_of(settings, "material.a", "material.b"),
                    "attraction would end at b = " + number_text(material.b) +
                        " radii before it begins at a = " + number_text(material.a),
                    "give an a below b");
  check_isotropy(settings);
  if (material.modulus_direction && material.modulus_direction->norm() == 0)
    throw bad_input(settings.place("material.modulus_direction"), "a direction without length",
                    "give [x, y, z], not all zero");
}

/// Reports errors at the scene's line.
void check_box(const Settings& settings, const char* key,
               const std::optional<std::array<double, 6>>& box) {
  if (!box) return;
  const auto& [x0, y0, z0, x1, y1, z1] = *box;
  if (!(x0 < x1 && y0 < y1 && z0 < z1))
    throw bad_input(settings.place(key), "a box whose corners are not in order",
                    "give x, y, z of its least corner, then of its greatest");
}

void check_output(const Settings& settings) {
  const auto check = [&](const char* key, auto* names_of, const std::string& words) {
    try {
      names_of(words);
    } catch (const Error& error) {
      throw error.with_context(settings.place(key));
    }
  };
  check("output.arrays", requested_arrays, settings.output.arrays);
  check("output.only", frame_arrays, settings.output.only);
  check("output.skin", skin_arrays, settings.output.skin);
  check_box(settings, "output.region", settings.output.region);
  if (settings.output.volume && (settings.output.region || settings.output.inside_every > 1))
    throw bad_input(place_of(settings, "output.volume",
                             settings.output.region ? "output.region" : "output.inside_every"),
                    "the cells of a body are between all of its particles",
                    "remove output.volume, or what leaves particles out");
  if (settings.output.inside_every > 1 && !is_lattice(settings.body.packing))
    throw bad_input(settings.place("output.inside_every"),
                    "only in lattices do neighbors tell how deep a particle lies",
                    "set body.packing to fcc or hcp, or remove it");
}

/// Each frame has four lines for each bone.
void check_bone_count(const Settings& settings) {
  constexpr std::size_t max_bones = 10'000;
  if (settings.bones.size() > max_bones)
    throw bad_input(settings.place("skeleton.bones"),
                    "there are " + std::to_string(settings.bones.size()) + " bones, more than " +
                        std::to_string(max_bones),
                    "leave out those that move nothing");
}

void check_axes(const Settings& settings) {
  const char* cure = "name two different axes, as in up: y and forward: z";
  if (to_scene(settings.body).determinant() < 0.5)
    throw bad_input(place_of(settings, "body.forward", "body.up"),
                    "up and forward of the mesh lie along one axis", cure);
  if (to_scene(settings.skeleton).determinant() < 0.5)
    throw bad_input(place_of(settings, "skeleton.forward", "skeleton.up"),
                    "up and forward of the rig lie along one axis", cure);
}

void check_clip(const Settings& settings) {
  const MotionOptions& motion = settings.motion;
  if (motion.end && !(*motion.end > motion.start))
    throw bad_input(place_of(settings, "motion.end", "motion.start"),
                    "the clip would end at " + number_text(*motion.end) +
                        " s before it begins at " + number_text(motion.start) + " s",
                    "give an end after motion.start");
}

/// The place of the first of these keys that the scene gives.
Place place_of(const Settings& scene, const std::vector<std::string_view>& keys) {
  for (const std::string_view key : keys)
    if (const auto found = scene.places.find(key); found != scene.places.end())
      return found->second;
  return scene.place(keys.empty() ? "" : std::string(keys.front()));
}

Features features_of_material(const Settings& scene) {
  using enum Feature;
  const MaterialOptions& material = scene.material;
  const bool bonded = has_bonds(material.model);
  const bool at_rest = scene.solver.method == Method::static_equilibrium;
  const bool parts = any_has(scene.materials, &LocalMaterialSettings::is_elastic) ||
                     any_has(scene.bodies, &PartOptions::young_modulus);
  return features_where({
      {paper, !bonded},
      {modulus_direction, material.modulus_direction.has_value()},
      {bonds, bonded},
      {bonds_alone, material.model == MaterialModel::bonded},
      {k1, material.k1.has_value()},
      {nearest_bonds, !is_isotropic(material, scene.body.packing)},
      {isotropy, material.isotropic.value_or(false)},
      {part_stiffness, parts},
      {part_ratio, any_has(scene.materials, &LocalMaterialSettings::poisson_ratio)},
      {part_volume, parts && keeps_volume(material.model)},
      {part_density, any_has(scene.materials, &LocalMaterialSettings::density)},
      {breaking, material.breaking_strain || material.fracture_energy ||
                     any_has(scene.materials, &LocalMaterialSettings::breaking_strain)},
      {yielding,
       material.yield_strain || any_has(scene.materials, &LocalMaterialSettings::yield_strain)},
      // In equilibria, bonds have relaxed.
      {relaxing, material.relaxation_shares && !(at_rest && bonded)},
      {rayleigh, material.rayleigh.has_value()},
      {attraction, !bonded && material.cohesion == Cohesion::all},
      {one_cohesion, material.cohesion != Cohesion::all},
  });
}

}  // namespace

Features features_of(const Settings& scene) {
  using enum Feature;
  const SolverSettings& solver = scene.solver;
  const WorldSettings& world = scene.world;
  const bool at_rest = solver.method == Method::static_equilibrium;
  const bool moves =
      !(scene.tracks.empty() && scene.motion.file.empty() && scene.skeleton.file.empty());
  Features all = features_where({
      {cells, solver.neighbor_search == NeighborSearch::cells},
      {single_precision, solver.precision == Precision::binary32},
      {groups, scene.hierarchy.enabled},
      {equilibria, at_rest},
      {integrator, solver.integrator != Integrator::symplectic_euler},
      {motion, !at_rest},
      {time_step, solver.time_step.has_value()},
      {residual, solver.residual.has_value()},
      {static_solver, solver.static_solver != StaticSolver::automatic},
      {velocities, scene.moves_initially()},
      {preroll, scene.motion.preroll.value_or(0) > 0},
      {first_pose, scene.motion.begin == Begin::pose && moves},
      {bodies, !scene.bodies.empty()},
      {layer, scene.body.thickness.has_value()},
      {other_packing, scene.body.packing != Packing::fcc},
      {hcp, scene.body.packing == Packing::hcp},
      {friction, scene.material.friction > 0},
      {bones, !scene.bones.empty() || !scene.skeleton.file.empty()},
      {pass_through, scene.contact.pass_through.any()},
      {open_loop, scene.binding.twist_form == TwistForm::open_loop},
      {max_force, scene.binding.max_force.has_value()},
      {drag, world.drag > 0},
      {obstacles, !world.obstacles.empty()},
      {rough_obstacles, any_has(world.obstacles, &ObstacleSettings::friction)},
      {mesh_obstacles,
       any_has(world.obstacles, [](const auto& one) { return one.shape == ObstacleShape::mesh; })},
      {pins, !world.pins.empty()},
      {fields, !world.fields.empty()},
      {muscles, !world.muscles.empty()},
      {supports_along, any_has(scene.supports, &SupportSettings::hold_along)},
      {pressures, any_has(scene.loads, &LoadSettings::pressure)},
      {springs, !world.springs.empty()},
  });
  all.merge(features_of_material(scene));
  return all;
}

void check_features(const Settings& scene, const Features& more) {
  Features all = features_of(scene);
  all.insert(more.begin(), more.end());
  for (const Feature other : all)
    if (const auto conflict = conflict_with(other, all))
      throw bad_input(place_of(scene, conflict->feature.keys), conflict->what, conflict->cure);
}

std::span<const EitherOr> either_or() {
  static constexpr std::array<EitherOr, 5> pairs = {{
      {"body.radius", "body.count", true},
      {"material.young_modulus", "material.k1", false},
      {"material.lambda", "material.k2", false},
      {"material.damping", "material.damping_ratio", false},
      {"material.breaking_strain", "material.fracture_energy", false},
  }};
  return pairs;
}

std::string_view rival_of(std::string_view path) {
  for (const EitherOr& pair : either_or()) {
    if (pair.first == path) return pair.second;
    if (pair.second == path) return pair.first;
  }
  return "";
}

void apply_preset(Settings& settings) {
  MaterialOptions& material = settings.material;
  const MaterialPreset* preset = preset_named(material.preset);
  if (preset == nullptr) return;
  const auto free = [&](std::string_view key) {
    const std::string_view rival = rival_of(key);
    const bool written = settings.places.find(key) != settings.places.end();  // even as none
    return !written && (rival.empty() || !is_given(settings, rival));
  };
  if (free("material.density")) material.density = preset->density;
  if (free("material.young_modulus")) material.young_modulus = preset->young_modulus;
  if (free("material.poisson_ratio")) material.poisson_ratio = preset->poisson_ratio;
  if (free("material.damping_ratio") && !material.rayleigh)
    material.damping_ratio = preset->damping_ratio;
  if (preset->yield_strain && free("material.model")) material.model = MaterialModel::bonded;
  if (has_bonds(material.model) && free("material.yield_strain"))
    material.yield_strain = preset->yield_strain;
}

void check_together(const Settings& settings) {
  for (const EitherOr& pair : either_or()) check_pair(settings, pair);
  check_material(settings);
  check_bone_count(settings);
  check_axes(settings);
  check_clip(settings);
  check_output(settings);
  check_box(settings, "hierarchy.free_region", settings.hierarchy.free_region);
  check_features(settings);
  const double duration = settings.solver.duration, interval = settings.output.interval;
  if (duration > 0 && interval > duration)
    throw bad_input(
        place_of(settings, "output.interval", "solver.duration"),
        "frames every " + number_text(interval) + " s in a run of " + number_text(duration) + " s",
        "give output.interval a value up to solver.duration");
}

}  // namespace sinew

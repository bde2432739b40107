// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/settings/sections.h>

#include <array>
#include <string>

#include <sinew/core/arrays.h>
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
  if (material.isotropic.value_or(false)) {
    if (!has_bonds(material.model))
      throw bad_input(settings.place("material.isotropic"),
                      "the paper's model has no bonds that could make it isotropic",
                      "set material.model to bonded or bonded_volume, or remove it");
    if (settings.body.packing == Packing::hcp)
      throw bad_input(settings.place("material.isotropic"),
                      "the hcp packing cannot be made isotropic",
                      "set body.packing to fcc, or material.isotropic to false");
  }
  if (keeps_volume(material.model) && !is_isotropic(material, settings.body.packing) &&
      (material.poisson_ratio < 0.26 || material.poisson_ratio > 0.45))
    throw bad_input(settings.place("material.poisson_ratio"),
                    "twelve bonds a particle reach Poisson's ratios from 0.26 to 0.45, not " +
                        number_text(material.poisson_ratio),
                    "give one between, or set material.isotropic to true");
}

/// Parts of a body may be as stiff as they like where bonds have factors of their own.
void check_local_modulus(const Settings& settings, const std::string& path, const char* what) {
  const Place place = settings.place(path);
  if (!is_isotropic(settings.material, settings.body.packing))
    throw bad_input(place, std::string("only isotropic bonded ") + what + " differ in stiffness",
                    "set material.model to bonded, and body.packing to fcc, or remove it");
  if (settings.material.k1)
    throw bad_input(place,
                    std::string(what) + " differ in stiffness, but material.k1 gives that of all",
                    "give material.young_modulus instead of k1");
}

void check_local_material(const Settings& settings, std::size_t index) {
  const LocalMaterialSettings& material = settings.materials[index];
  const std::string path = "materials[" + std::to_string(index) + "]";
  if (material.is_elastic()) check_local_modulus(settings, path, "parts of a body");
  if (material.poisson_ratio && !keeps_volume(settings.material.model))
    throw bad_input(settings.place(path + ".poisson_ratio"),
                    "Poisson's ratio of bonds alone is 1/4, whatever they are of",
                    "set material.model to bonded_volume, or remove it");
  if (material.has_strength() && !has_bonds(settings.material.model))
    throw bad_input(
        settings.place(path),
        "material '" + material.name + "' has a strength of bonds, and the paper's model has none",
        "set material.model to bonded or bonded_volume, or remove it");
}

void check_bodies(const Settings& settings) {
  for (std::size_t i = 0; i < settings.bodies.size(); ++i)
    if (settings.bodies[i].young_modulus)
      check_local_modulus(settings, "bodies[" + std::to_string(i) + "].young_modulus", "bodies");
  for (std::size_t i = 0; i < settings.materials.size(); ++i) check_local_material(settings, i);
}

/// Branches of bonds that relax.
void check_relaxation(const Settings& settings) {
  const auto& ratios = settings.material.relaxation_shares;
  const auto& times = settings.material.relaxation_times;
  if (!ratios && !times) return;
  const Place place = place_of(settings, "material.relaxation_shares", "material.relaxation_times");
  if (!has_bonds(settings.material.model))
    throw bad_input(place, "the branches that relax are of bonds, and the paper's model has none",
                    "set material.model to bonded or bonded_volume, or remove them");
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
  if (material.damping_form.value_or(by_default) != DampingForm::rigid ||
      settings.hierarchy.enabled)
    throw bad_input(place, "material.rayleigh is for damping_form rigid, without hierarchy",
                    "set material.model to bonded or bonded_volume, and remove damping_form and "
                    "hierarchy");
}

void check_material(const Settings& settings) {
  check_bodies(settings);
  check_relaxation(settings);
  check_rayleigh(settings);
  const MaterialOptions& material = settings.material;
  if (!(material.a < material.b))
    throw bad_input(place_of(settings, "material.a", "material.b"),
                    "attraction would end at b = " + number_text(material.b) +
                        " radii before it begins at a = " + number_text(material.a),
                    "give an a below b");
  const bool bonded = has_bonds(material.model);
  if (material.breaking_strain && material.fracture_energy)
    throw bad_input(place_of(settings, "material.breaking_strain", "material.fracture_energy"),
                    "material.fracture_energy sets the breaking strain, which is also given",
                    "remove one of the two");
  for (const char* key :
       {"material.breaking_strain", "material.fracture_energy", "material.yield_strain"})
    if (is_given(settings, key) && !bonded)
      throw bad_input(settings.place(key),
                      std::string(key) + " is of bonds, and the paper's model has none",
                      "set material.model to bonded or bonded_volume, or remove it");
  check_isotropy(settings);
  if (material.cohesion != Cohesion::all && bonded)
    throw bad_input(settings.place("material.cohesion"),
                    "bonded models attract only through their bonds",
                    "remove material.cohesion, or set material.model to paper");
  if (material.friction > 0 && !bonded && material.cohesion == Cohesion::all)
    throw bad_input(settings.place("material.friction"),
                    "parts that touch attract each other, and do not slide",
                    "set material.cohesion to initial_neighbors or material.model to bonded, or "
                    "remove it");
  if (!material.modulus_direction) return;
  if (material.modulus_direction->norm() == 0)
    throw bad_input(settings.place("material.modulus_direction"), "a direction without length",
                    "give [x, y, z], not all zero");
  if (settings.body.packing != Packing::fcc)
    throw bad_input(settings.place("material.modulus_direction"),
                    "moduli along a direction are known for fcc only",
                    "set body.packing to fcc, or remove it");
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

void check_contact(const Settings& settings) {
  if (settings.hierarchy.enabled && settings.contact.pass_through.any())
    throw bad_input(settings.place("contact.pass_through"),
                    "groups of particles do not pass through each other",
                    "remove contact.pass_through, or set hierarchy.enabled to false");
  if (!settings.binding.max_force) return;
  const Place place = settings.place("binding.max_force");
  if (settings.binding.twist_form == TwistForm::open_loop)
    throw bad_input(place, "the twist of open_loop stores no energy by which it could yield",
                    "remove binding.max_force, or set binding.twist_form to servo");
  if (settings.hierarchy.enabled)
    throw bad_input(place, "bones hold groups of particles whatever it takes",
                    "remove binding.max_force, or set hierarchy.enabled to false");
}

/// Equilibria have no velocities.
void check_at_rest(const Settings& settings) {
  const auto check = [&](const BodyOptions& body, const std::string& path) {
    if (!body.moves()) return;
    const std::string key = path + (body.velocity.isZero(0) ? ".angular_velocity" : ".velocity");
    throw bad_input(settings.place(key), "the static method knows no " + key,
                    "remove it, or set solver.method to dynamic");
  };
  check(settings.body, "body");
  for (std::size_t i = 0; i < settings.bodies.size(); ++i)
    check(settings.bodies[i].body, "bodies[" + std::to_string(i) + "]");
}

/// What the static method does not know.
void check_static(const Settings& settings) {
  const SolverSettings& solver = settings.solver;
  const auto refuse = [&](const char* key, const char* what, const char* cure) {
    throw bad_input(settings.place(key), what, cure);
  };
  if (solver.method == Method::dynamic) {
    if (is_given(settings, "solver.residual"))
      refuse("solver.residual", "the dynamic method brings nothing to a residual",
             "set solver.method to static, or remove it");
    if (solver.static_solver != StaticSolver::automatic)
      refuse("solver.static_solver", "the dynamic method finds no equilibria",
             "set solver.method to static, or remove it");
    return;
  }
  check_at_rest(settings);
  if (solver.integrator != Integrator::symplectic_euler)
    refuse("solver.integrator", "the static method integrates no motion in time",
           "remove solver.integrator, or set solver.method to dynamic");
  if (is_given(settings, "solver.time_step"))
    refuse("solver.time_step", "the static method has no time step",
           "remove solver.time_step, or set solver.method to dynamic");
  if (solver.neighbor_search == NeighborSearch::cells)
    refuse("solver.neighbor_search", "the static method searches neighbors by lists only",
           "remove solver.neighbor_search, or set solver.method to dynamic");
  if (settings.material.friction > 0)
    refuse("material.friction", "friction has no one equilibrium",
           "remove material.friction, or set solver.method to dynamic");
  if (settings.binding.twist_form == TwistForm::open_loop)
    refuse("binding.twist_form", "nothing balances the twist of open_loop",
           "set binding.twist_form to servo, or solver.method to dynamic");
}

}  // namespace

std::span<const EitherOr> either_or() {
  static constexpr std::array<EitherOr, 4> pairs = {{
      {"body.radius", "body.count", true},
      {"material.young_modulus", "material.k1", false},
      {"material.lambda", "material.k2", false},
      {"material.damping", "material.damping_ratio", false},
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
  check_contact(settings);
  check_output(settings);
  check_box(settings, "hierarchy.free_region", settings.hierarchy.free_region);
  check_static(settings);
  const double duration = settings.solver.duration, interval = settings.output.interval;
  if (duration > 0 && interval > duration)
    throw bad_input(
        place_of(settings, "output.interval", "solver.duration"),
        "frames every " + number_text(interval) + " s in a run of " + number_text(duration) + " s",
        "give output.interval a value up to solver.duration");
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/settings/table.h>

#include <sinew/settings/row.h>

namespace sinew {
namespace {

using namespace rows;

std::vector<std::string_view> axes() { return {"x", "y", "z", "-x", "-y", "-z"}; }

/// Which mesh, where it is, and how it is repaired; Owner has a member `body`.
template <class S>
std::vector<Field<S>> rows_of_mesh(std::string_view section) {
  return {
      required(path(field<S>(
          section, "mesh", SINEW_AT(S, body.mesh), "",
          "path of the mesh (OBJ, OFF, STL, PLY, glTF, GLB, VRM, FBX, COLLADA, VTP, VTU, VTK, "
          "VTI), relative to the scene file"))),
      choice<S>(section, "unit", SINEW_AT(S, body.unit), {"m", "dm", "cm", "mm", "um", "in", "ft"},
                "unit of the mesh's lengths"),
      field<S>(section, "scale", SINEW_AT(S, body.scale), "",
               "factor on the mesh's lengths, in addition to the unit", positive),
      choice<S>(section, "up", SINEW_AT(S, body.up), axes(),
                "axis of the mesh that becomes the scene's z"),
      choice<S>(section, "forward", SINEW_AT(S, body.forward), axes(),
                "axis of the mesh that becomes the scene's x; auto: the axis after up, in the "
                "order x, y, z, x"),
      field<S>(section, "rotation", SINEW_AT(S, body.rotation), "degrees",
               "rotation of the mesh about the scene's x, then y, then z axis, after up and "
               "forward"),
      field<S>(section, "offset", SINEW_AT(S, body.offset), "m",
               "displacement of the mesh, after scale and rotation"),
      field<S>(section, "velocity", SINEW_AT(S, body.velocity), "m/s",
               "initial velocity of what fills the mesh"),
      field<S>(section, "angular_velocity", SINEW_AT(S, body.angular_velocity), "degrees/s",
               "initial angular velocity of what fills the mesh, about its center of mass"),
      field<S>(section, "level", SINEW_AT(S, body.level), "",
               "value of an image (VTI, VTK) at the surface; auto: 0, or halfway between the "
               "extremes where all values have one sign"),
      field<S>(section, "weld", SINEW_AT(S, body.weld), "m",
               "merges points of the mesh closer than this; 0 merges identical points only",
               not_negative),
      field<S>(section, "close_holes", SINEW_AT(S, body.close_holes), "",
               "closes the holes of the mesh with new faces before any other step"),
      field<S>(
          section, "wrap", SINEW_AT(S, body.wrap), "m",
          "replaces the mesh by a closed surface around it, which ignores gaps narrower than this",
          positive, "none"),
  };
}

std::vector<Field<Settings>> make_body() {
  using S = Settings;
  std::vector<Field<S>> rows = rows_of_mesh<S>("body");
  const std::vector<Field<S>> others = {
      choice<S>("body", "rule", SINEW_AT(S, body.rule), {"union", "hollow"},
                "union: inside is where the winding number exceeds 0.5; hollow: every second "
                "nested closed shell is a cavity"),
      field<S>("body", "thickness", SINEW_AT(S, body.thickness), "m",
               "fills a layer of this thickness along the surface instead of its inside", positive,
               "none"),
      field<S>("body", "radius", SINEW_AT(S, body.radius), "m",
               "particle radius; give this or count", positive),
      field<S>("body", "count", SINEW_AT(S, body.count), "",
               "approximate number of particles; the radius follows from the mesh's volume",
               {1, 1e9}),
      choice<S>("body", "packing", SINEW_AT(S, body.packing), {"fcc", "hcp", "random", "conformal"},
                "fcc, hcp: closest packings; random: as dense, without order; conformal: fcc whose "
                "outer layer follows the surface"),
      field<S>("body", "lattice_origin", SINEW_AT(S, body.lattice_origin), "m",
               "position of one site of the packing; auto: the center of the mesh's bounding box"),
      field<S>("body", "lattice_rotation", SINEW_AT(S, body.lattice_rotation), "degrees",
               "rotation of the packing about its x, then y, then z axis; random: any, by the seed",
               any, "random"),
      field<S>("body", "seed", SINEW_AT(S, body.seed), "",
               "what a random packing or rotation depends on"),
      choice<S>("body", "keep", SINEW_AT(S, body.keep), {"center", "sphere"},
                "part of a particle that must lie inside the body"),
      field<S>("body", "clearance", SINEW_AT(S, body.clearance), "m",
               "least distance of that part from the surface", not_negative),
  };
  rows.insert(rows.end(), others.begin(), others.end());
  return rows;
}

std::vector<Field<PartOptions>> make_part() {
  std::vector<Field<PartOptions>> rows = rows_of_mesh<PartOptions>("");
  rows.push_back(field<PartOptions>("", "young_modulus", SINEW_AT(PartOptions, young_modulus), "Pa",
                                    "Young's modulus of this body; auto: material.young_modulus",
                                    positive));
  return rows;
}

std::vector<std::string_view> names_of_models() {
  std::vector<std::string_view> names;
  names.reserve(material_models.size());
  for (const MaterialModelRow& model : material_models) names.push_back(model.name);
  return names;
}

std::vector<std::string_view> names_of_presets() {
  std::vector<std::string_view> names = {"none"};
  for (const MaterialPreset& preset : material_presets()) names.push_back(preset.name);
  return names;
}

std::vector<Field<Settings>> make_material() {
  using S = Settings;
  return {
      choice<S>("material", "preset", SINEW_AT(S, material.preset), names_of_presets(),
                "named material: sets density, young_modulus, poisson_ratio and damping_ratio "
                "where the scene does not; sinew presets lists them"),
      choice<S>(
          "material", "model", SINEW_AT(S, material.model), names_of_models(),
          "paper: Komiya and Tokoi's, has no fixed bonds and flows under large bending; bonded: "
          "keeps its bonds and returns to its shape; bonded_volume: also preserves its volume"),
      choice<S>("material", "cohesion", SINEW_AT(S, material.cohesion),
                {"all", "initial_neighbors"},
                "attraction in the paper's model; all: between any particles that come near, so "
                "parts that touch stick; initial_neighbors: only between neighbors at rest"),
      field<S>("material", "density", SINEW_AT(S, material.density), "kg/m^3",
               "mass of the body divided by its mesh's volume", positive),
      field<S>("material", "young_modulus", SINEW_AT(S, material.young_modulus), "Pa",
               "Young's modulus, averaged over directions (Hill); sets k1 = E / 2.701", positive),
      field<S>("material", "modulus_direction", SINEW_AT(S, material.modulus_direction), "",
               "direction in the scene along which young_modulus holds, for fcc packing", any,
               "none"),
      field<S>(
          "material", "poisson_ratio", SINEW_AT(S, material.poisson_ratio), "",
          "Poisson's ratio of bonded_volume; bonded has 0.25, the paper's model 0.261 averaged "
          "over directions (Hill)",
          {0.25, 0.49}),
      field<S>("material", "isotropic", SINEW_AT(S, material.isotropic), "",
               "bonded models hold second neighbors as well, a quarter as stiff, and surfaces in "
               "proportion: young_modulus holds in every direction; fcc only",
               any, "auto"),
      field<S>("material", "k1", SINEW_AT(S, material.k1), "Pa",
               "the paper's repulsion constant, instead of young_modulus", positive),
      field<S>("material", "k2", SINEW_AT(S, material.k2), "Pa",
               "the paper's attraction constant, instead of lambda", not_negative),
      field<S>("material", "lambda", SINEW_AT(S, material.lambda), "",
               "ratio of tensile to compressive stiffness at contact, k2 (b - a) / (4 k1 r)",
               not_negative),
      field<S>("material", "a", SINEW_AT(S, material.a), "radii",
               "distance at which attraction begins", {2, inf}),
      field<S>(
          "material", "b", SINEW_AT(S, material.b), "radii",
          "distance at which attraction ends; above 2.75 second neighbors pull, and lambda decides "
          "whether the body holds (0.05 does)",
          {2, 8, true}),
  };
}

std::vector<Field<Settings>> make_damping() {
  using S = Settings;
  return {
      field<S>("material", "damping", SINEW_AT(S, material.damping), "sqrt(k m)",
               "damping constant C on the relative velocity of neighbors", not_negative),
      field<S>("material", "damping_ratio", SINEW_AT(S, material.damping_ratio), "",
               "damping ratio of the body's lowest elastic mode, instead of damping", not_negative,
               "none"),
      choice<S>(
          "material", "damping_form", SINEW_AT(S, material.damping_form),
          {"paper", "symmetric", "central", "rigid"},
          "paper: eq. 2, which brakes turning bodies; symmetric: conserves momentum; central: also "
          "conserves angular momentum; rigid: central, and what damping_ratio lacks is damping "
          "relative to what holds the body, or to its motion as a rigid body, which takes no "
          "shorter steps; auto: rigid for bonded models without hierarchy, else paper"),
      field<S>(
          "material", "rayleigh", SINEW_AT(S, material.rayleigh), "1/s, s",
          "[alpha, beta] of Rayleigh's damping, instead of damping and damping_ratio: a mode of "
          "angular frequency w has the ratio alpha / (2 w) + beta w / 2; alpha acts on motion "
          "relative to what holds the body, beta is reached in the lowest mode; for damping_form "
          "rigid",
          not_negative, "none"),
  };
}

/// What bonds and touching parts bear.
std::vector<Field<Settings>> make_strength() {
  using S = Settings;
  return {
      field<S>("material", "breaking_strain", SINEW_AT(S, material.breaking_strain), "",
               "strain at which a bond breaks, in bonded models", positive, "none"),
      field<S>("material", "fracture_energy", SINEW_AT(S, material.fracture_energy), "J/m^2",
               "energy of the bonds that a crack cuts, per area, in bonded models: sets "
               "breaking_strain so that it does not depend on the radius; a crack that grows takes "
               "3.2 to 3.6 times as much",
               positive, "none"),
      field<S>(
          "material", "yield_strain", SINEW_AT(S, material.yield_strain), "",
          "strain of a bar that is pulled beyond which it flows, keeping its volume, in bonded "
          "models",
          positive, "none"),
      field<S>(
          "material", "creep_rate", SINEW_AT(S, material.creep_rate), "1/s",
          "fraction of the shear beyond yield_strain that flows per unit of time: a bar pulled at "
          "the rate e is pulled at 1 + 1.2 e / (creep_rate yield_strain) of its yield stress (nu "
          "0.25); auto: 2 % more than that stress at the fastest rate that bones, supports, "
          "obstacles, loads and velocities of the scene command, by their turns and their speeds "
          "over the body's smallest width; check prints it",
          not_negative, "auto"),
      field<S>("material", "relaxation_shares", SINEW_AT(S, material.relaxation_shares), "",
               "shares of young_modulus, which holds at once, that relax in time (Prony's g_i), of "
               "up to four branches, in bonded models; the static method finds what is left",
               {0, 1, true}, "none"),
      field<S>("material", "relaxation_times", SINEW_AT(S, material.relaxation_times), "s",
               "their relaxation times (tau_i), one each", positive, "none"),
      field<S>("material", "friction", SINEW_AT(S, material.friction), "",
               "coefficient of dry friction between parts of the body that touch, where those do "
               "not attract: in bonded models, and with cohesion initial_neighbors; layers of "
               "particles interlock, so that with 0 a block still rests on a slope of 20 degrees",
               not_negative),
  };
}

std::vector<Field<Settings>> make_skeleton_section() {
  using S = Settings;
  return {
      path(may_lack("none", field<S>("skeleton", "file", SINEW_AT(S, skeleton.file), "",
                                     "rig file, instead of bones: YAML with a list of bones, BVH, "
                                     "glTF, GLB, VRM, FBX or COLLADA"))),
      field<S>("skeleton", "scale", SINEW_AT(S, skeleton.scale), "",
               "factor on the lengths of the rig and its motion", positive),
      choice<S>("skeleton", "up", SINEW_AT(S, skeleton.up), axes(),
                "axis of the rig that becomes the scene's z"),
      choice<S>("skeleton", "forward", SINEW_AT(S, skeleton.forward), axes(),
                "axis of the rig that becomes the scene's x; auto: the axis after up, in the order "
                "x, y, z, x"),
      field<S>("skeleton", "rotation", SINEW_AT(S, skeleton.rotation), "degrees",
               "rotation of the rig about the scene's x, then y, then z axis, after up and "
               "forward"),
      field<S>("skeleton", "offset", SINEW_AT(S, skeleton.offset), "m",
               "displacement of the rig, after scale and rotation"),
      choice<S>("skeleton", "fit", SINEW_AT(S, skeleton.fit), {"none", "mesh"},
                "mesh: scales, rotates and moves the rig so that it lies inside the mesh; the "
                "scene written with the run has the values found"),
      field<S>("skeleton", "rest_at", SINEW_AT(S, skeleton.rest_at), "s",
               "time in the clip whose pose is the rest pose, instead of the file's, for a mesh "
               "made in that pose; motion.start counts as before",
               not_negative, "none"),
  };
}

Field<Settings> names_row() {
  Field<Settings> row;
  row.section = "motion";
  row.name = "names";
  row.kind = FieldKind::pairs;
  row.choices = {"none"};
  row.help =
      "which joint of the clip moves which bone, as [bone, joint], whatever their rest poses; "
      "none: those of one name";
  row.get = [](const Settings& settings) -> FieldValue {
    const std::vector<NamePair>& given = settings.motion.names;
    return given.empty() ? FieldValue(std::string("none")) : FieldValue(given);
  };
  row.set = [](Settings& settings, const FieldValue& value) {
    const auto* pairs = std::get_if<std::vector<NamePair>>(&value);
    settings.motion.names = pairs == nullptr ? std::vector<NamePair>() : *pairs;
  };
  return row;
}

std::vector<Field<Settings>> make_motion_section() {
  using S = Settings;
  return {
      path(may_lack("none",
                    field<S>("motion", "file", SINEW_AT(S, motion.file), "",
                             "clip file, instead of tracks: YAML with a list of tracks, BVH, glTF, "
                             "GLB, VRM, FBX, COLLADA, or a table of keys (.csv) as sinew play "
                             "records them"))),
      may_lack("auto", field<S>("motion", "clip", SINEW_AT(S, motion.clip), "",
                                "name of the clip, if the file has several; auto: the only clip")),
      names_row(),
      field<S>("motion", "start", SINEW_AT(S, motion.start), "s",
               "time in the clip at which the motion begins", not_negative),
      field<S>("motion", "end", SINEW_AT(S, motion.end), "s",
               "time in the clip at which the motion ends; auto: its last key", positive),
      field<S>("motion", "frame_rate", SINEW_AT(S, motion.frame_rate), "1/s",
               "frames per second of keys given in frames; auto: the rate of the file", positive),
      choice<S>("motion", "positions", SINEW_AT(S, motion.positions), {"replace", "add"},
                "whether positions in a BVH file replace a joint's offset or are added to it"),
      choice<S>(
          "motion", "extrapolation", SINEW_AT(S, motion.extrapolation),
          {"hold", "loop", "ping_pong"},
          "motion after the end of the clip: hold the last pose, repeat, or play back and forth"),
      field<S>("motion", "speed", SINEW_AT(S, motion.speed), "",
               "rate at which the clip plays: 0.5 takes twice the time", positive),
      field<S>("motion", "preroll", SINEW_AT(S, motion.preroll), "s",
               "time before the clip in which the bones move smoothly from rest to its first pose; "
               "auto: 0 for tracks; for the clip of a file 1 s per 90 degrees or per half size of "
               "the skeleton, or 0 where the body begins in that pose",
               not_negative),
      choice<S>(
          "motion", "begin", SINEW_AT(S, motion.begin), {"rest", "pose", "auto"},
          "state of the body at the start; rest: at rest; pose: skinned into the clip's first pose "
          "and relaxed; auto: so where a joint turns by over 90 degrees, the clip jumps there in a "
          "frame, or the way from rest leads through the body"),
  };
}

std::vector<Field<Settings>> make_binding() {
  using S = Settings;
  return {
      choice<S>(
          "binding", "method", SINEW_AT(S, binding.method), {"nearest", "inside", "file"},
          "bone of a particle; nearest: the one with the nearest segment; inside: the nearest by "
          "distance inside the body; file: by the weights of the glTF file in skeleton.file"),
      field<S>("binding", "core_radius", SINEW_AT(S, binding.core_radius), "m",
               "particles farther than this from their bone are unbound and follow their neighbors",
               positive, "none"),
      choice<S>("binding", "force", SINEW_AT(S, binding.force), {"paper", "anchor"},
                "paper: radial, twist and axial springs; anchor: a spring to the rigid pose"),
      choice<S>("binding", "twist_form", SINEW_AT(S, binding.twist_form), {"servo", "open_loop"},
                "servo: drives particles to the bone's angle; open_loop: pushes in proportion to "
                "that angle"),
      field<S>("binding", "stiffness", SINEW_AT(S, binding.stiffness), "E V0 / A",
               "stiffness of the radial (or anchor) spring of each particle", not_negative),
      field<S>("binding", "twist_stiffness", SINEW_AT(S, binding.twist_stiffness), "E V0 / A",
               "stiffness against rotation about the bone", not_negative),
      field<S>("binding", "axial_stiffness", SINEW_AT(S, binding.axial_stiffness), "E V0 / A",
               "stiffness against sliding along the bone", not_negative),
      field<S>("binding", "bone_damping", SINEW_AT(S, binding.bone_damping), "",
               "damping ratio of the bone springs", not_negative),
      field<S>(
          "binding", "joint_zone", SINEW_AT(S, binding.joint_zone), "sqrt(A)",
          "length over which weights blend from one bone to the next; 0: one bone per particle",
          not_negative),
      field<S>("binding", "rigid_below", SINEW_AT(S, binding.rigid_below), "particles",
               "parts that are fewer particles thick follow their bone rigidly; 0: none do",
               not_negative),
      field<S>("binding", "soften_below", SINEW_AT(S, binding.soften_below), "particles",
               "a bone of fewer particles pulls each as if it had so many: it follows less "
               "closely, and needs no shorter time step; 0: none does",
               not_negative),
      field<S>("binding", "max_force", SINEW_AT(S, binding.max_force), "N",
               "bound on the force with which a bone holds a particle: its springs yield below it",
               positive, "none"),
  };
}

std::vector<Field<Settings>> make_contact() {
  Field<Settings> row;
  row.section = "contact";
  row.name = "pass_through";
  row.kind = FieldKind::pairs;
  row.choices = {"auto"};
  row.absent = "none";
  row.help =
      "pairs of bones whose flesh exerts no contact on each other, but where it is near at rest; "
      "auto: those whose flesh the motion drives into each other by over 1.5 radii, as check lists "
      "them";
  row.get = [](const Settings& settings) -> FieldValue {
    const PassThroughOptions& given = settings.contact.pass_through;
    if (given.automatic) return std::string("auto");
    return given.pairs.empty() ? FieldValue() : FieldValue(given.pairs);
  };
  row.set = [](Settings& settings, const FieldValue& value) {
    PassThroughOptions& given = settings.contact.pass_through = {};
    given.automatic = std::holds_alternative<std::string>(value);
    if (const auto* pairs = std::get_if<std::vector<NamePair>>(&value)) given.pairs = *pairs;
  };
  return {row};
}

std::vector<Field<Settings>> make_world() {
  using S = Settings;
  return {
      field<S>("world", "drag", SINEW_AT(S, world.drag), "1/s",
               "drag of the medium: deceleration divided by velocity", not_negative),
  };
}

std::vector<Field<Settings>> make_solver() {
  using S = Settings;
  return {
      choice<S>("solver", "method", SINEW_AT(S, solver.method), {"dynamic", "static"},
                "dynamic: motion in time; static: brings the body to rest in each frame, with its "
                "supports, loads and bones as they are at that time"),
      choice<S>("solver", "integrator", SINEW_AT(S, solver.integrator),
                {"symplectic_euler", "explicit_euler", "velocity_verlet"},
                "time integration of positions and velocities"),
      field<S>("solver", "time_step", SINEW_AT(S, solver.time_step), "s",
               "upper bound of the step; auto: time_step_factor times the stability limit",
               positive),
      field<S>("solver", "time_step_factor", SINEW_AT(S, solver.time_step_factor), "",
               "fraction of the stability limit that time_step: auto uses", {0, 1, true}),
      field<S>("solver", "duration", SINEW_AT(S, solver.duration), "s", "simulated time of the run",
               not_negative),
      field<S>("solver", "gravity", SINEW_AT(S, solver.gravity), "m/s^2",
               "acceleration of gravity"),
      choice<S>("solver", "precision", SINEW_AT(S, solver.precision), {"double", "single"},
                "precision of the steps; single is about twice as fast"),
      choice<S>("solver", "neighbor_search", SINEW_AT(S, solver.neighbor_search),
                {"lists", "cells"},
                "how neighbors are found; cells: the paper's cells, a slow, readable reference"),
      field<S>("solver", "wall_time", SINEW_AT(S, solver.wall_time), "s",
               "wall-clock time after which the run stops and can be resumed; none: no limit",
               positive, "none"),
      field<S>(
          "solver", "residual", SINEW_AT(S, solver.residual), "",
          "static: the sum of all forces that nothing answers, over the largest load or "
          "reaction, at which the body counts as at rest; auto: 1e-6, or up to 1e-4 where rounding "
          "leaves that, in single precision 0.01",
          {0, 0.1, true}),
      field<S>("solver", "iterations", SINEW_AT(S, solver.iterations), "",
               "static: the most iterations for a frame, after which the run fails and can be "
               "resumed with more",
               Range{1, 1e9}),
      choice<S>("solver", "static_solver", SINEW_AT(S, solver.static_solver),
                {"auto", "newton", "relaxation"},
                "static: how equilibria are found; newton: by Newton's method, of bonded bodies "
                "that do not flow, break or rub, and whose tangent has a factor of fewer than 5e7 "
                "nonzeros; auto: so where that is faster, as of slender bodies"),
  };
}

std::vector<Field<Settings>> make_hierarchy() {
  using S = Settings;
  return {
      field<S>(
          "hierarchy", "enabled", SINEW_AT(S, hierarchy.enabled), "",
          "groups what is far from joints that move and from obstacles: no forces are computed "
          "within; fcc"),
      field<S>("hierarchy", "dynamic", SINEW_AT(S, hierarchy.dynamic), "",
               "groups change: cells join that move affinely, and leave where forces tear"),
      choice<S>("hierarchy", "motion", SINEW_AT(S, hierarchy.motion), {"affine", "cubic"},
                "of large groups in bonded bodies; auto: cubic; all others are affine"),
      field<S>("hierarchy", "joint_distance", SINEW_AT(S, hierarchy.joint_distance), "sqrt(A)",
               "free up to here from joints that move; auto: 1, or 0.52 and more for cubic groups",
               not_negative),
      field<S>("hierarchy", "tolerance", SINEW_AT(S, hierarchy.tolerance), "r",
               "what may join dynamic groups is off by less; what leaves would be", positive),
      field<S>("hierarchy", "surface_distance", SINEW_AT(S, hierarchy.surface_distance), "m",
               "free up to here from the surface", not_negative),
      field<S>("hierarchy", "free_region", SINEW_AT(S, hierarchy.free_region), "m",
               "free in a box at rest: x, y, z of its least corner, then of its greatest", any,
               "none"),
      may_lack("none", field<S>("hierarchy", "free_bones", SINEW_AT(S, hierarchy.free_bones), "",
                                "free is what any of these bones holds, such as \"hand, wrist\"")),
      field<S>("hierarchy", "min_particles", SINEW_AT(S, hierarchy.min_particles), "",
               "particles of a group, at least; of one that bends, 16384 in any case",
               Range{64, 1e9}),
  };
}

std::vector<Field<Settings>> make_settings() {
  std::vector<Field<Settings>> all;
  for (const auto& section :
       {make_body(), make_material(), make_damping(), make_strength(), make_skeleton_section(),
        make_motion_section(), make_binding(), make_contact(), make_world(), make_solver(),
        make_hierarchy(), output_rows()})
    all.insert(all.end(), section.begin(), section.end());
  return all;
}

}  // namespace

std::string Range::text() const {
  const bool below = low > -rows::inf, above = high < rows::inf;
  if (below && above && above_low) return "> " + number_text(low) + ", up to " + number_text(high);
  if (below && above) return number_text(low) + " to " + number_text(high);
  if (below) return (above_low ? "> " : ">= ") + number_text(low);
  return above ? "<= " + number_text(high) : "";
}

std::span<const Field<Settings>> settings_table() {
  static const auto table = make_settings();
  return table;
}

std::span<const Field<PartOptions>> part_fields() {
  static const auto table = make_part();
  return table;
}

std::span<const std::string_view> sections() {
  static constexpr std::array<std::string_view, 10> names = {
      "body",    "material", "skeleton", "motion",    "binding",
      "contact", "world",    "solver",   "hierarchy", "output"};
  return names;
}

}  // namespace sinew

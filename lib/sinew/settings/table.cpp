// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/settings/table.h>

#include <sinew/settings/row.h>

namespace sinew {
namespace {

using namespace rows;

std::vector<std::string_view> axes() { return {"x", "y", "z", "-x", "-y", "-z"}; }

std::vector<Field<Settings>> make_body() {
  using S = Settings;
  return {
      required(path(field<S>("body", "mesh", SINEW_AT(S, body.mesh), "",
                             "mesh (OBJ, OFF, STL, PLY, glTF, GLB), relative to the scene"))),
      choice<S>("body", "unit", SINEW_AT(S, body.unit), {"m", "dm", "cm", "mm", "um", "in", "ft"},
                "what the mesh's lengths are given in"),
      field<S>("body", "scale", SINEW_AT(S, body.scale), "",
               "factor on the mesh's lengths, beside the unit", positive),
      choice<S>("body", "up", SINEW_AT(S, body.up), axes(),
                "axis of the mesh that becomes the scene's z"),
      choice<S>("body", "forward", SINEW_AT(S, body.forward), axes(),
                "axis of the mesh that becomes the scene's x; auto: the one after up (x, y, z, x)"),
      field<S>("body", "weld", SINEW_AT(S, body.weld), "m",
               "points of the mesh closer than this become one; 0 joins equal ones only",
               not_negative),
      choice<S>(
          "body", "rule", SINEW_AT(S, body.rule), {"union", "hollow"},
          "inside is where the winding number is above 0.5 (union); hollow makes every second "
          "closed shell within others a cavity"),
      field<S>("body", "close_holes", SINEW_AT(S, body.close_holes), "",
               "close the mesh's holes with new faces before anything else"),
      field<S>("body", "wrap", SINEW_AT(S, body.wrap), "m",
               "replace the mesh by a closed skin around it, blind to gaps narrower than this",
               positive, "none"),
      field<S>("body", "thickness", SINEW_AT(S, body.thickness), "m",
               "fill a layer this thick along the surface instead of its inside", positive, "none"),
      field<S>("body", "radius", SINEW_AT(S, body.radius), "m",
               "particle radius; give this or count", positive),
      field<S>("body", "count", SINEW_AT(S, body.count), "",
               "about how many particles; the radius follows from the mesh's volume", {1, 1e9}),
      choice<S>("body", "packing", SINEW_AT(S, body.packing), {"fcc", "hcp"},
                "closest packing of the particles"),
      field<S>("body", "lattice_origin", SINEW_AT(S, body.lattice_origin), "m",
               "where a site of the packing lies; auto is the center of the mesh's box"),
      field<S>("body", "lattice_rotation", SINEW_AT(S, body.lattice_rotation), "degrees",
               "turns the packing about its x, then y, then z axis"),
      choice<S>("body", "keep", SINEW_AT(S, body.keep), {"center", "sphere"},
                "what of a particle has to lie within the body"),
      field<S>("body", "clearance", SINEW_AT(S, body.clearance), "m",
               "how far within the body it has to lie", not_negative),
  };
}

std::vector<Field<Settings>> make_material() {
  using S = Settings;
  return {
      choice<S>("material", "preset", SINEW_AT(S, material.preset),
                {"none", "fat", "muscle", "skin", "silicone", "rubber_foam", "clay"},
                "a material by name: density, young_modulus, poisson_ratio and damping_ratio where "
                "the scene gives none"),
      choice<S>(
          "material", "model", SINEW_AT(S, material.model), {"paper", "bonded", "bonded_volume"},
          "paper: Komiya and Tokoi's, without fixed bonds, flows when bent far; bonded: keeps "
          "its bonds and comes back; bonded_volume: keeps its volume too"),
      choice<S>("material", "cohesion", SINEW_AT(S, material.cohesion),
                {"all", "initial_neighbors"},
                "who attracts whom in the paper's model: all that come near, so that parts that "
                "touch stick, or only neighbors at rest"),
      field<S>("material", "density", SINEW_AT(S, material.density), "kg/m^3",
               "mass of the body over its mesh's volume", positive),
      field<S>("material", "young_modulus", SINEW_AT(S, material.young_modulus), "Pa",
               "Young's modulus, averaged over directions (Hill); sets k1 = E / 2.701", positive),
      field<S>("material", "modulus_direction", SINEW_AT(S, material.modulus_direction), "",
               "young_modulus is meant along this direction of the scene, in a packing of fcc", any,
               "none"),
      field<S>("material", "poisson_ratio", SINEW_AT(S, material.poisson_ratio), "",
               "of bonded_volume, averaged over directions (Hill); the others have 0.261",
               {0.26, 0.45}),
      field<S>("material", "k1", SINEW_AT(S, material.k1), "Pa",
               "the paper's repulsion constant, instead of young_modulus", positive),
      field<S>("material", "k2", SINEW_AT(S, material.k2), "Pa",
               "the paper's attraction constant, instead of lambda", not_negative),
      field<S>("material", "lambda", SINEW_AT(S, material.lambda), "",
               "stiffness in tension over compression at contact, k2 (b - a) / (4 k1 r)",
               not_negative),
      field<S>("material", "a", SINEW_AT(S, material.a), "radii",
               "distance at which attraction begins", {2, inf}),
      field<S>("material", "b", SINEW_AT(S, material.b), "radii",
               "distance at which attraction ends; above 2.75 the packing is unstable",
               {2, 8, true}),
      field<S>("material", "damping", SINEW_AT(S, material.damping), "sqrt(k m)",
               "damping constant C of neighbors' relative velocity", not_negative),
      field<S>("material", "damping_ratio", SINEW_AT(S, material.damping_ratio), "",
               "of the body's first bending, instead of damping", not_negative, "none"),
      choice<S>("material", "damping_form", SINEW_AT(S, material.damping_form),
                {"paper", "symmetric", "central"},
                "paper: eq. 2; symmetric keeps momentum; central keeps angular momentum too"),
      field<S>("material", "breaking_strain", SINEW_AT(S, material.breaking_strain), "",
               "stretch at which a bond breaks, over its length; of bonded models", positive,
               "none"),
      field<S>("material", "yield_strain", SINEW_AT(S, material.yield_strain), "",
               "strain of a bond beyond which its rest length creeps after it; of bonded models",
               positive, "none"),
      field<S>("material", "creep_rate", SINEW_AT(S, material.creep_rate), "1/s",
               "share of the strain beyond yield_strain that creeps away per time", not_negative),
  };
}

std::vector<Field<Settings>> make_skeleton_section() {
  using S = Settings;
  return {
      path(may_lack("none",
                    field<S>("skeleton", "file", SINEW_AT(S, skeleton.file), "",
                             "rig instead of bones: YAML with a list of bones, BVH, glTF or GLB"))),
      field<S>("skeleton", "scale", SINEW_AT(S, skeleton.scale), "",
               "factor on the lengths of the rig and its motion", positive),
      choice<S>("skeleton", "up", SINEW_AT(S, skeleton.up), axes(),
                "axis of the rig that becomes the scene's z"),
      choice<S>("skeleton", "forward", SINEW_AT(S, skeleton.forward), axes(),
                "axis of the rig that becomes the scene's x; auto: the one after up (x, y, z, x)"),
  };
}

std::vector<Field<Settings>> make_motion_section() {
  using S = Settings;
  return {
      path(may_lack("none",
                    field<S>("motion", "file", SINEW_AT(S, motion.file), "",
                             "clip instead of tracks: YAML with a list of tracks, BVH, glTF or "
                             "GLB"))),
      may_lack("auto",
               field<S>("motion", "clip", SINEW_AT(S, motion.clip), "",
                        "name of the clip, where the file has several; auto: the only one")),
      field<S>("motion", "start", SINEW_AT(S, motion.start), "s",
               "time of the clip at which it begins", not_negative),
      field<S>("motion", "end", SINEW_AT(S, motion.end), "s",
               "time of the clip at which it ends; auto: its last key", positive),
      field<S>("motion", "frame_rate", SINEW_AT(S, motion.frame_rate), "1/s",
               "frames per second, for keys in frames; auto: the file's own", positive),
      choice<S>("motion", "positions", SINEW_AT(S, motion.positions), {"replace", "add"},
                "positions in a BVH stand in place of a joint's offset or are added to it"),
      choice<S>("motion", "extrapolation", SINEW_AT(S, motion.extrapolation),
                {"hold", "loop", "ping_pong"},
                "after the clip's end: stand still, begin again, or go back and forth"),
      field<S>("motion", "preroll", SINEW_AT(S, motion.preroll), "s",
               "time before the clip in which the bones go smoothly from rest to its first pose",
               not_negative),
  };
}

std::vector<Field<Settings>> make_binding() {
  using S = Settings;
  return {
      choice<S>("binding", "method", SINEW_AT(S, binding.method), {"nearest", "inside", "file"},
                "bone of a particle: of the nearest segment; nearest by a way inside the body; by "
                "the weights of the glTF file in skeleton.file"),
      field<S>("binding", "core_radius", SINEW_AT(S, binding.core_radius), "m",
               "particles farther from their bone have none and follow their neighbors", positive,
               "none"),
      choice<S>("binding", "force", SINEW_AT(S, binding.force), {"paper", "anchor"},
                "paper: radial, twist and axial springs; anchor: a spring to the rigid pose"),
      choice<S>("binding", "twist_form", SINEW_AT(S, binding.twist_form), {"servo", "open_loop"},
                "servo turns to the bone's angle; open_loop pushes in proportion to it"),
      field<S>("binding", "stiffness", SINEW_AT(S, binding.stiffness), "E V0 / A",
               "radial (or anchor) spring of each particle", not_negative),
      field<S>("binding", "twist_stiffness", SINEW_AT(S, binding.twist_stiffness), "E V0 / A",
               "spring against turning about the bone", not_negative),
      field<S>("binding", "axial_stiffness", SINEW_AT(S, binding.axial_stiffness), "E V0 / A",
               "spring against sliding along the bone", not_negative),
      field<S>("binding", "bone_damping", SINEW_AT(S, binding.bone_damping), "",
               "damping ratio of the bone springs", not_negative),
      field<S>("binding", "joint_zone", SINEW_AT(S, binding.joint_zone), "sqrt(A)",
               "length over which weights pass from one bone to the next; 0: one bone each",
               not_negative),
  };
}

std::vector<Field<Settings>> make_world() {
  using S = Settings;
  return {
      field<S>("world", "drag", SINEW_AT(S, world.drag), "1/s",
               "of the medium: its braking acceleration over the velocity", not_negative),
  };
}

std::vector<Field<Settings>> make_solver() {
  using S = Settings;
  return {
      choice<S>("solver", "integrator", SINEW_AT(S, solver.integrator),
                {"symplectic_euler", "explicit_euler", "velocity_verlet"},
                "how positions and velocities advance"),
      field<S>("solver", "time_step", SINEW_AT(S, solver.time_step), "s",
               "upper bound of the step; auto: time_step_factor times the stability limit",
               positive),
      field<S>("solver", "time_step_factor", SINEW_AT(S, solver.time_step_factor), "",
               "share of the stability limit used by time_step: auto", {0, 1, true}),
      field<S>("solver", "duration", SINEW_AT(S, solver.duration), "s", "length of the run",
               not_negative),
      field<S>("solver", "gravity", SINEW_AT(S, solver.gravity), "m/s^2",
               "acceleration of gravity"),
      choice<S>("solver", "precision", SINEW_AT(S, solver.precision), {"double", "single"},
                "of the steps; single is about twice as fast"),
      choice<S>("solver", "neighbor_search", SINEW_AT(S, solver.neighbor_search),
                {"lists", "cells"},
                "how partners are found; cells: the paper's, a slow and readable reference"),
      field<S>("solver", "wall_time", SINEW_AT(S, solver.wall_time), "s",
               "of the clock on the wall, after which the run stops to be resumed; none: no limit",
               positive, "none"),
  };
}

std::vector<Field<Settings>> make_output() {
  using S = Settings;
  return {
      field<S>("output", "interval", SINEW_AT(S, output.interval), "s",
               "time of the scene between frames", positive),
      field<S>("output", "checkpoint_interval", SINEW_AT(S, output.checkpoint_interval), "s",
               "of the clock on the wall between checkpoints, from which --resume goes on",
               not_negative),
      choice<S>("output", "encoding", SINEW_AT(S, output.encoding), {"zlib", "lz4", "raw", "none"},
                "of the arrays in VTU files; none is plain base64; raw is for readers other than "
                "VTK before 9.3"),
      field<S>("output", "double_precision", SINEW_AT(S, output.double_precision), "",
               "write Float64 instead of Float32"),
      field<S>("output", "skin_lbs", SINEW_AT(S, output.skin_lbs), "",
               "write the surface moved by linear-blend skinning too, for comparison"),
      field<S>("output", "skin_dqs", SINEW_AT(S, output.skin_dqs), "",
               "write the surface moved by dual-quaternion skinning too, for comparison"),
      field<S>("output", "export", SINEW_AT(S, output.export_surface), "",
               "write the moving surface for Blender, 3ds Max, Maya: surface.obj (rest) with "
               "surface.pc2 (point cache), and surface.glb (morph targets)"),
      may_lack("none", field<S>("output", "arrays", SINEW_AT(S, output.arrays), "",
                                "more arrays of particles, as in \"J, stress\", or all: F, J, "
                                "stretch, strain, hencky_strain, strain_eq, stress, von_mises, "
                                "D2min, turnover, inverted, pose_error")),
  };
}

std::vector<Field<Settings>> make_settings() {
  std::vector<Field<Settings>> all;
  for (const auto& section :
       {make_body(), make_material(), make_skeleton_section(), make_motion_section(),
        make_binding(), make_world(), make_solver(), make_output()})
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

std::span<const std::string_view> sections() {
  static constexpr std::array<std::string_view, 8> names = {
      "body", "material", "skeleton", "motion", "binding", "world", "solver", "output"};
  return names;
}

}  // namespace sinew

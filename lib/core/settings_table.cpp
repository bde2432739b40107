// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/settings_table.h"

#include <algorithm>
#include <array>
#include <type_traits>

namespace sinew {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr Range any = {};
constexpr Range positive = {0, inf, true};
constexpr Range not_negative = {0, inf, false};

template <class T>
struct Unwrap {
  using type = T;
  static constexpr bool optional = false;
};
template <class T>
struct Unwrap<std::optional<T>> {
  using type = T;
  static constexpr bool optional = true;
};

/// How many numbers a std::array holds; 0 for anything else.
template <class T>
constexpr std::size_t count_of = 0;
template <std::size_t n>
constexpr std::size_t count_of<std::array<double, n>> = n;

template <class T>
constexpr bool is_list = count_of<T> > 0 || std::is_same_v<T, std::vector<double>>;

/// Members as they lie in a FieldValue: arrays become lists.
template <class T>
FieldValue stored_as_field(const T& value) {
  if constexpr (count_of < T >> 0)
    return std::vector<double>(value.begin(), value.end());
  else
    return value;
}

template <class T>
T from_field(const FieldValue& field) {
  if constexpr (count_of < T >> 0) {
    const auto& list = std::get<std::vector<double>>(field);
    T value{};
    std::copy_n(list.begin(), std::min(list.size(), value.size()), value.begin());
    return value;
  } else {
    return std::get<T>(field);
  }
}

template <class T>
constexpr FieldKind kind_of() {
  if constexpr (std::is_same_v<T, double>)
    return FieldKind::number;
  else if constexpr (std::is_same_v<T, int>)
    return FieldKind::whole;
  else if constexpr (std::is_same_v<T, bool>)
    return FieldKind::flag;
  else if constexpr (std::is_same_v<T, Vec3>)
    return FieldKind::vector;
  else if constexpr (is_list<T>)
    return FieldKind::numbers;
  else
    return FieldKind::text;
}

/// A field for the member that `member(owner)` refers to; optional members may be absent.
template <class Owner, class Member>
Field<Owner> field(std::string_view section, std::string_view name, Member member,
                   std::string_view unit, std::string_view help, Range range = any,
                   std::string_view absent = "auto") {
  using Stored = std::remove_reference_t<decltype(member(std::declval<Owner&>()))>;
  using Value = typename Unwrap<Stored>::type;
  Field<Owner> row;
  row.section = section;
  row.name = name;
  row.kind = kind_of<Value>();
  row.count = count_of<Value>;
  row.unit = unit;
  row.help = help;
  row.range = range;
  if (Unwrap<Stored>::optional) row.absent = absent;
  row.get = [member](const Owner& owner) -> FieldValue {
    const Stored& stored = member(const_cast<Owner&>(owner));
    if constexpr (Unwrap<Stored>::optional)
      return stored ? stored_as_field(*stored) : FieldValue();
    else
      return stored_as_field(stored);
  };
  row.set = [member](Owner& owner, const FieldValue& value) {
    if constexpr (Unwrap<Stored>::optional)
      if (std::holds_alternative<std::monostate>(value)) return member(owner).reset();
    member(owner) = from_field<Value>(value);
  };
  return row;
}

/// A field for an enum; `choices` in the order of its values. An optional one may be auto.
template <class Owner, class Member>
Field<Owner> choice(std::string_view section, std::string_view name, Member member,
                    std::vector<std::string_view> choices, std::string_view help) {
  using Stored = std::remove_reference_t<decltype(member(std::declval<Owner&>()))>;
  using Enum = typename Unwrap<Stored>::type;
  Field<Owner> row;
  row.section = section;
  row.name = name;
  row.kind = FieldKind::choice;
  row.help = help;
  row.choices = choices;
  if (Unwrap<Stored>::optional) row.absent = "auto";
  row.get = [member, choices](const Owner& owner) -> FieldValue {
    const std::optional<Enum> stored = member(const_cast<Owner&>(owner));
    if (!stored) return {};
    return std::string(choices[static_cast<std::size_t>(*stored)]);
  };
  row.set = [member, choices](Owner& owner, const FieldValue& value) {
    if constexpr (Unwrap<Stored>::optional)
      if (std::holds_alternative<std::monostate>(value)) return member(owner).reset();
    for (std::size_t i = 0; i < choices.size(); ++i)
      if (choices[i] == std::get<std::string>(value)) member(owner) = static_cast<Enum>(i);
  };
  return row;
}

template <class Owner>
Field<Owner> required(Field<Owner> row) {
  row.required = true;
  return row;
}

template <class Owner>
Field<Owner> path(Field<Owner> row) {
  row.kind = FieldKind::path;
  return row;
}

/// A text that may be left out: the empty text is written as `word`.
template <class Owner>
Field<Owner> may_lack(std::string_view word, Field<Owner> row) {
  row.absent = word;
  row.get = [get = row.get](const Owner& owner) -> FieldValue {
    FieldValue value = get(owner);
    return std::get<std::string>(value).empty() ? FieldValue() : value;
  };
  row.set = [set = row.set](Owner& owner, const FieldValue& value) {
    set(owner, std::holds_alternative<std::monostate>(value) ? FieldValue(std::string()) : value);
  };
  return row;
}

// Names a member: SINEW_AT(Settings, body.radius) is a function from Settings& to that member.
#define SINEW_AT(Owner, member) \
  [](Owner & owner) -> auto& { return owner.member; }

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
               "where a site of the packing lies; auto is the centre of the mesh's box"),
      field<S>("body", "lattice_rotation", SINEW_AT(S, body.lattice_rotation), "degrees",
               "turns the packing about its x, then y, then z axis"),
      choice<S>("body", "keep", SINEW_AT(S, body.keep), {"centre", "sphere"},
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
                {"all", "initial_neighbours"},
                "who attracts whom in the paper's model: all that come near, so that parts that "
                "touch stick, or only neighbours at rest"),
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
               "damping constant C of neighbours' relative velocity", not_negative),
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
               "particles farther from their bone have none and follow their neighbours", positive,
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
      choice<S>("solver", "neighbour_search", SINEW_AT(S, solver.neighbour_search),
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

std::vector<Field<BoneSettings>> make_bones() {
  using B = BoneSettings;
  return {
      required(field<B>("", "name", SINEW_AT(B, name), "", "unique name of the bone")),
      may_lack("none", field<B>("", "parent", SINEW_AT(B, parent), "", "name of an earlier bone")),
      field<B>("", "head", SINEW_AT(B, head), "m",
               "where it begins at rest; auto: at its parent's tail"),
      field<B>("", "tail", SINEW_AT(B, tail), "m", "where it ends at rest; give this or length",
               any, "none"),
      field<B>("", "length", SINEW_AT(B, length), "m", "from head to tail, instead of tail",
               positive, "none"),
      field<B>("", "direction", SINEW_AT(B, direction), "",
               "where it points, with length, of any size; auto: where its parent points"),
      field<B>("", "connected", SINEW_AT(B, connected), "",
               "whether it begins at its parent's tail; auto: where it has no head"),
      field<B>("", "roll", SINEW_AT(B, roll), "degrees",
               "turns its sides about it; at 0 the first side is across the bone and that axis of "
               "x, y, z which is least along it"),
      field<B>("", "stiffness", SINEW_AT(B, stiffness), "", "factor on binding.stiffness",
               not_negative),
      field<B>("", "twist_stiffness", SINEW_AT(B, twist_stiffness), "",
               "factor on binding.twist_stiffness", not_negative),
      field<B>("", "axial_stiffness", SINEW_AT(B, axial_stiffness), "",
               "factor on binding.axial_stiffness", not_negative),
  };
}

std::vector<Field<LimitSettings>> make_limits() {
  using L = LimitSettings;
  return {
      field<L>("", "swing", SINEW_AT(L, swing), "degrees",
               "how far the bone may lean from its direction at rest on its parent", {0, 180},
               "none"),
      field<L>("", "twist", SINEW_AT(L, twist), "degrees",
               "least and greatest turn about the bone itself", any, "none"),
  };
}

std::vector<Field<BoundSettings>> make_bound() {
  using B = BoundSettings;
  return {
      may_lack("none", field<B>("", "bone", SINEW_AT(B, bone), "",
                                "name of the bone that holds these particles, and no other")),
      field<B>("", "ids", SINEW_AT(B, ids), "", "numbers of the particles, as in body.vtu",
               not_negative, "none"),
      field<B>("", "low", SINEW_AT(B, low), "m", "least corner of the box that they lie in", any,
               "none"),
      field<B>("", "high", SINEW_AT(B, high), "m", "greatest corner of that box", any, "none"),
      field<B>("", "centre", SINEW_AT(B, centre), "m", "of the ball that they lie in", any, "none"),
      field<B>("", "radius", SINEW_AT(B, radius), "m", "of that ball", positive, "none"),
  };
}

std::vector<Field<TrackSettings>> make_tracks() {
  using T = TrackSettings;
  return {
      required(field<T>("", "bone", SINEW_AT(T, bone), "", "name of the bone that moves")),
      choice<T>("", "interpolation", SINEW_AT(T, interpolation),
                {"step", "linear", "smooth", "cubic"},
                "between keys; smooth rests at each, cubic passes them without a jump of speed"),
      field<T>("", "order", SINEW_AT(T, order), "", "order of euler angles, such as xyz or zyx"),
  };
}

std::vector<Field<KeySettings>> make_keys() {
  using K = KeySettings;
  return {
      field<K>("", "time", SINEW_AT(K, time), "s", "when this key holds", not_negative, "none"),
      field<K>("", "frame", SINEW_AT(K, frame), "",
               "the same in frames, from 0, instead of time; motion.frame_rate has their rate",
               not_negative, "none"),
      field<K>("", "axis", SINEW_AT(K, axis), "",
               "axis of the rotation, in the parent's directions", any, "none"),
      field<K>("", "angle", SINEW_AT(K, angle), "degrees",
               "angle about the axis, of any size: keys about one axis turn all the way", any,
               "none"),
      field<K>("", "euler", SINEW_AT(K, euler), "degrees",
               "rotation about x, y and z of the parent's directions, instead of axis and angle",
               any, "none"),
      field<K>("", "quaternion", SINEW_AT(K, quaternion), "",
               "rotation as [w, x, y, z] of length 1, instead of axis and angle", any, "none"),
      field<K>("", "twist", SINEW_AT(K, twist), "degrees",
               "turn about the bone itself, of any size, after the rotation"),
      field<K>("", "translation", SINEW_AT(K, translation), "m",
               "shift of the head from its place on the parent"),
      field<K>("", "stretch", SINEW_AT(K, stretch), "",
               "factor of the bone's length; what hangs on the bone moves with it", positive),
  };
}

std::vector<Field<ObstacleSettings>> make_obstacles() {
  using O = ObstacleSettings;
  return {
      required(field<O>("", "name", SINEW_AT(O, name), "", "unique name of the obstacle")),
      required(choice<O>("", "shape", SINEW_AT(O, shape),
                         {"plane", "sphere", "capsule", "box", "mesh"},
                         "a plane is solid behind it; the others are solid within")),
      field<O>("", "point", SINEW_AT(O, point), "m", "of a plane: any point of it"),
      field<O>("", "normal", SINEW_AT(O, normal), "",
               "of a plane: out of the solid, of any length but 0"),
      field<O>("", "centre", SINEW_AT(O, centre), "m", "of a sphere or box", any, "none"),
      field<O>("", "radius", SINEW_AT(O, radius), "m", "of a sphere or capsule", positive, "none"),
      field<O>("", "from", SINEW_AT(O, from), "m", "of a capsule: one end of its axis", any,
               "none"),
      field<O>("", "to", SINEW_AT(O, to), "m", "of a capsule: the other end", any, "none"),
      field<O>("", "size", SINEW_AT(O, size), "m", "of a box: its edges along x, y and z", any,
               "none"),
      field<O>("", "rotation", SINEW_AT(O, rotation), "degrees",
               "of a box: turns it about its x, then y, then z axis"),
      path(may_lack("none", field<O>("", "mesh", SINEW_AT(O, mesh), "",
                                     "of a mesh: a closed surface (formats and lengths as "
                                     "body.mesh), relative to the scene"))),
      may_lack("none", field<O>("", "bone", SINEW_AT(O, bone), "",
                                "name of the bone that carries it; or give keys; or it stands")),
      field<O>("", "friction", SINEW_AT(O, friction), "", "coefficient of dry friction",
               not_negative),
      field<O>("", "stiffness", SINEW_AT(O, stiffness), "k",
               "of the contact, over that of two particles", positive),
      field<O>("", "damping", SINEW_AT(O, damping), "sqrt(k m)", "of what approaches it",
               not_negative),
      choice<O>("", "interpolation", SINEW_AT(O, interpolation),
                {"step", "linear", "smooth", "cubic"}, "between keys, as of motion.tracks"),
  };
}

std::vector<Field<PlaceKeySettings>> make_place_keys() {
  using K = PlaceKeySettings;
  return {
      required(field<K>("", "time", SINEW_AT(K, time), "s", "when this key holds", not_negative)),
      field<K>("", "translation", SINEW_AT(K, translation), "m", "shift from its place at first"),
      field<K>("", "axis", SINEW_AT(K, axis), "", "axis through its middle that it turns about"),
      field<K>("", "angle", SINEW_AT(K, angle), "degrees", "angle about the axis, of any size"),
  };
}

/// The keys of the region that an entry of a list has in its member `region`; `what` is in it.
template <class Owner>
std::vector<Field<Owner>> make_region(std::string_view box, std::string_view ball) {
  return {
      field<Owner>("", "low", SINEW_AT(Owner, region.low), "m", box, any, "none"),
      field<Owner>("", "high", SINEW_AT(Owner, region.high), "m", "its greatest corner", any,
                   "none"),
      field<Owner>("", "centre", SINEW_AT(Owner, region.centre), "m", ball, any, "none"),
      field<Owner>("", "radius", SINEW_AT(Owner, region.radius), "m", "its radius", positive,
                   "none"),
  };
}

template <class Owner>
Field<Owner> falloff() {
  return field<Owner>("", "falloff", SINEW_AT(Owner, region.falloff), "m",
                      "width of a soft edge outside the region", not_negative);
}

std::vector<Field<PinSettings>> make_pins() {
  using P = PinSettings;
  auto rows = make_region<P>("holds the particles in a box at rest: its least corner",
                             "or in a ball: its centre");
  rows.push_back(may_lack("none", field<P>("", "bone", SINEW_AT(P, bone), "",
                                           "name of the bone that carries them; none: they stay")));
  return rows;
}

std::vector<Field<FieldSettings>> make_fields() {
  using F = FieldSettings;
  std::vector<Field<F>> rows = {
      required(field<F>("", "name", SINEW_AT(F, name), "", "unique name of the field")),
      choice<F>("", "shape", SINEW_AT(F, shape), {"uniform", "density", "attraction", "swirl"},
                "one acceleration; a force per volume; towards a point; around an axis"),
      field<F>("", "acceleration", SINEW_AT(F, acceleration), "m/s^2",
               "uniform: that it gives to what is in its region", any, "none"),
      field<F>("", "density", SINEW_AT(F, density), "N/m^3",
               "density: force per volume of the body at rest", any, "none"),
      field<F>("", "point", SINEW_AT(F, point), "m",
               "attraction: the point; swirl: any point of its axis", any, "none"),
      field<F>("", "axis", SINEW_AT(F, axis), "",
               "swirl: direction of its axis, right-handed, of any length but 0"),
      field<F>("", "strength", SINEW_AT(F, strength), "m/s^2",
               "attraction and swirl: acceleration outside the core; below 0: the other way", any,
               "none"),
      field<F>("", "core", SINEW_AT(F, core), "m",
               "attraction and swirl: within this distance it falls to 0 in proportion", positive,
               "none"),
  };
  for (auto& row : make_region<F>("acts in a box of the scene: its least corner; none: everywhere",
                                  "or in a ball: its centre"))
    rows.push_back(std::move(row));
  rows.push_back(falloff<F>());
  return rows;
}

std::vector<Field<MuscleSettings>> make_muscles() {
  using M = MuscleSettings;
  std::vector<Field<M>> rows = {
      required(field<M>("", "name", SINEW_AT(M, name), "", "unique name of the muscle")),
      may_lack("none",
               field<M>("", "bone", SINEW_AT(M, bone), "",
                        "it lies along this bone, in what is bound to it if no region is given")),
      field<M>("", "direction", SINEW_AT(M, direction), "",
               "of its fibres at rest, of any length but 0; auto: along the bone"),
      required(field<M>("", "strength", SINEW_AT(M, strength), "Pa",
                        "active stress along the fibres at activation 1", not_negative)),
  };
  for (auto& row :
       make_region<M>("lies in a box at rest: its least corner", "or in a ball: its centre"))
    rows.push_back(std::move(row));
  rows.push_back(falloff<M>());
  return rows;
}

std::vector<Field<ValueKeySettings>> make_value_keys(std::string_view name, std::string_view help,
                                                     Range range) {
  using K = ValueKeySettings;
  return {
      required(field<K>("", "time", SINEW_AT(K, time), "s", "when this key holds", not_negative)),
      required(field<K>("", name, SINEW_AT(K, value), "", help, range)),
  };
}

#undef SINEW_AT

}  // namespace

std::string Range::text() const {
  const bool below = low > -inf, above = high < inf;
  if (below && above && above_low) return "> " + number_text(low) + ", up to " + number_text(high);
  if (below && above) return number_text(low) + " to " + number_text(high);
  if (below) return (above_low ? "> " : ">= ") + number_text(low);
  return above ? "<= " + number_text(high) : "";
}

std::span<const Field<Settings>> settings_table() {
  static const auto table = make_settings();
  return table;
}

std::span<const Field<BoneSettings>> bone_fields() {
  static const auto table = make_bones();
  return table;
}

std::span<const Field<LimitSettings>> limit_fields() {
  static const auto table = make_limits();
  return table;
}

std::span<const Field<BoundSettings>> bound_fields() {
  static const auto table = make_bound();
  return table;
}

std::span<const Field<TrackSettings>> track_fields() {
  static const auto table = make_tracks();
  return table;
}

std::span<const Field<KeySettings>> key_fields() {
  static const auto table = make_keys();
  return table;
}

std::span<const Field<ObstacleSettings>> obstacle_fields() {
  static const auto table = make_obstacles();
  return table;
}

std::span<const Field<PlaceKeySettings>> place_key_fields() {
  static const auto table = make_place_keys();
  return table;
}

std::span<const Field<PinSettings>> pin_fields() {
  static const auto table = make_pins();
  return table;
}

std::span<const Field<FieldSettings>> field_fields() {
  static const auto table = make_fields();
  return table;
}

std::span<const Field<ValueKeySettings>> strength_fields() {
  static const auto table =
      make_value_keys("strength", "factor on the field; straight lines between keys", any);
  return table;
}

std::span<const Field<MuscleSettings>> muscle_fields() {
  static const auto table = make_muscles();
  return table;
}

std::span<const Field<ValueKeySettings>> activation_fields() {
  static const auto table =
      make_value_keys("activation", "share of the strength; straight lines between keys", {0, 1});
  return table;
}

std::span<const std::string_view> sections() {
  static constexpr std::array<std::string_view, 8> names = {
      "body", "material", "skeleton", "motion", "binding", "world", "solver", "output"};
  return names;
}

}  // namespace sinew

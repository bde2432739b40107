// SPDX-License-Identifier: GPL-3.0-or-later
// The rows of the world around the body.
#include <sinew/settings/row.h>

namespace sinew {
namespace {

using namespace rows;

std::vector<std::string_view> shape_names() {
  std::vector<std::string_view> names;
  for (const ObstacleShapeRow& shape : obstacle_shapes()) names.push_back(shape.name);
  return names;
}

std::vector<Field<ObstacleSettings>> make_obstacles() {
  using O = ObstacleSettings;
  return {
      required(field<O>("", "name", SINEW_AT(O, name), "", "unique name of the obstacle")),
      required(choice<O>(
          "", "shape", SINEW_AT(O, shape), shape_names(),
          "shape of the obstacle; a plane is solid behind it, the others are solid inside")),
      field<O>("", "point", SINEW_AT(O, point), "m", "plane: any point on it"),
      field<O>("", "normal", SINEW_AT(O, normal), "",
               "plane: its normal, out of the solid, of any length but 0"),
      field<O>("", "center", SINEW_AT(O, center), "m", "sphere or box: its center", any, "none"),
      field<O>("", "radius", SINEW_AT(O, radius), "m", "sphere or capsule: its radius", positive,
               "none"),
      field<O>("", "from", SINEW_AT(O, from), "m", "capsule: one end of its axis", any, "none"),
      field<O>("", "to", SINEW_AT(O, to), "m", "capsule: the other end of its axis", any, "none"),
      field<O>("", "size", SINEW_AT(O, size), "m", "box: its edge lengths along x, y and z", any,
               "none"),
      field<O>("", "rotation", SINEW_AT(O, rotation), "degrees",
               "box: its rotation about its x, then y, then z axis"),
      path(may_lack("none", field<O>("", "mesh", SINEW_AT(O, mesh), "",
                                     "mesh: path of a closed surface (formats and lengths as "
                                     "body.mesh), relative to the scene file"))),
      may_lack("none", field<O>("", "bone", SINEW_AT(O, bone), "",
                                "name of the bone that it is attached to, instead of keys; without "
                                "either it is fixed")),
      field<O>("", "friction", SINEW_AT(O, friction), "", "coefficient of dry friction",
               not_negative),
      field<O>("", "stiffness", SINEW_AT(O, stiffness), "k",
               "stiffness of the contact, relative to that of two particles", positive),
      field<O>("", "damping", SINEW_AT(O, damping), "sqrt(k m)", "damping of what approaches it",
               not_negative),
      choice<O>("", "interpolation", SINEW_AT(O, interpolation),
                {"step", "linear", "smooth", "cubic"},
                "interpolation between keys, as in motion.tracks"),
  };
}

std::vector<Field<PlaceKeySettings>> make_place_keys() {
  using K = PlaceKeySettings;
  return {
      required(field<K>("", "time", SINEW_AT(K, time), "s", "time of this key", not_negative)),
      field<K>("", "translation", SINEW_AT(K, translation), "m",
               "displacement from its initial position"),
      field<K>("", "axis", SINEW_AT(K, axis), "", "axis of its rotation, through its center"),
      field<K>("", "angle", SINEW_AT(K, angle), "degrees", "angle about the axis, of any size"),
  };
}

/// The keys of the region in the member `region` of a list's entry; `what` is in it.
template <class Owner>
std::vector<Field<Owner>> make_region(std::string_view box, std::string_view ball) {
  return {
      field<Owner>("", "low", SINEW_AT(Owner, region.low), "m", box, any, "none"),
      field<Owner>("", "high", SINEW_AT(Owner, region.high), "m", "its upper corner", any, "none"),
      field<Owner>("", "center", SINEW_AT(Owner, region.center), "m", ball, any, "none"),
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
  auto rows = make_region<P>("holds the particles in a box at rest: its lower corner",
                             "or in a ball: its center");
  rows.push_back(may_lack(
      "none", field<P>("", "bone", SINEW_AT(P, bone), "",
                       "name of the bone that they are attached to; none: they are fixed")));
  return rows;
}

std::vector<Field<FieldSettings>> make_fields() {
  using F = FieldSettings;
  std::vector<Field<F>> rows = {
      required(field<F>("", "name", SINEW_AT(F, name), "", "unique name of the field")),
      choice<F>("", "shape", SINEW_AT(F, shape), {"uniform", "density", "attraction", "swirl"},
                "uniform: one acceleration; density: a force per volume; attraction: toward a "
                "point; swirl: around an axis"),
      field<F>("", "acceleration", SINEW_AT(F, acceleration), "m/s^2",
               "uniform: acceleration of what is in its region", any, "none"),
      field<F>("", "density", SINEW_AT(F, density), "N/m^3",
               "density: force per volume of the body at rest", any, "none"),
      field<F>("", "point", SINEW_AT(F, point), "m",
               "attraction: the point; swirl: any point of its axis", any, "none"),
      field<F>("", "axis", SINEW_AT(F, axis), "",
               "swirl: direction of its axis, right-handed, of any length but 0"),
      field<F>("", "strength", SINEW_AT(F, strength), "m/s^2",
               "attraction and swirl: acceleration outside the core; negative: in the opposite "
               "direction",
               any, "none"),
      field<F>("", "core", SINEW_AT(F, core), "m",
               "attraction and swirl: within this distance the acceleration falls linearly to 0",
               positive, "none"),
  };
  for (auto& row : make_region<F>("acts in a box of the scene: its lower corner; none: everywhere",
                                  "or in a ball: its center"))
    rows.push_back(std::move(row));
  rows.push_back(falloff<F>());
  return rows;
}

std::vector<Field<MuscleSettings>> make_muscles() {
  using M = MuscleSettings;
  std::vector<Field<M>> rows = {
      required(field<M>("", "name", SINEW_AT(M, name), "", "unique name of the muscle")),
      may_lack("none", field<M>("", "bone", SINEW_AT(M, bone), "",
                                "bone along which it lies; without a region, it consists of what "
                                "is bound to that bone")),
      field<M>("", "direction", SINEW_AT(M, direction), "",
               "direction of its fibers at rest, of any length but 0; auto: along the bone"),
      required(field<M>("", "strength", SINEW_AT(M, strength), "Pa",
                        "active stress along the fibers at activation 1", not_negative)),
  };
  for (auto& row :
       make_region<M>("lies in a box at rest: its lower corner", "or in a ball: its center"))
    rows.push_back(std::move(row));
  rows.push_back(falloff<M>());
  return rows;
}

std::vector<Field<SpringSettings>> make_springs() {
  using S = SpringSettings;
  return {
      required(field<S>("", "name", SINEW_AT(S, name), "",
                        "unique name of the spring, among those of loads and supports too")),
      field<S>("", "at", SINEW_AT(S, at), "m",
               "point of the body at rest, which follows the particles near it", any, "none"),
      field<S>("", "particle", SINEW_AT(S, particle), "", "or one particle, by its id",
               not_negative, "none"),
      required(field<S>("", "stiffness", SINEW_AT(S, stiffness), "N/m",
                        "force per distance from its free end", positive)),
  };
}

std::vector<Field<SpringKeySettings>> make_spring_keys() {
  using K = SpringKeySettings;
  return {
      required(field<K>("", "time", SINEW_AT(K, time), "s", "time of this key", not_negative)),
      required(
          field<K>("", "to", SINEW_AT(K, to), "m", "place of the free end; linear between keys")),
      field<K>("", "factor", SINEW_AT(K, factor), "",
               "factor on the force, 0: none; linear between keys", {0, 1}),
  };
}

std::vector<Field<ValueKeySettings>> make_value_keys(std::string_view name, std::string_view help,
                                                     Range range) {
  using K = ValueKeySettings;
  return {
      required(field<K>("", "time", SINEW_AT(K, time), "s", "time of this key", not_negative)),
      required(field<K>("", name, SINEW_AT(K, value), "", help, range)),
  };
}

}  // namespace

std::span<const ObstacleShapeRow> obstacle_shapes() {
  static const std::vector<ObstacleShapeRow> shapes = {{"plane", {}},
                                                       {"sphere", {"center", "radius"}},
                                                       {"capsule", {"from", "to", "radius"}},
                                                       {"box", {"center", "size"}},
                                                       {"mesh", {"mesh"}}};
  return shapes;
}

std::span<const Field<ObstacleSettings>> obstacle_fields() {
  static const auto table = make_obstacles();
  return table;
}

std::span<const Field<PlaceKeySettings>> place_key_fields() {
  static const auto table = make_place_keys();
  return table;
}

std::span<const Field<ValueKeySettings>> friction_key_fields() {
  static const auto table = make_value_keys(
      "factor", "factor on the obstacle's friction; linear between keys", not_negative);
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
      make_value_keys("strength", "factor on the field; linear between keys", any);
  return table;
}

std::span<const Field<MuscleSettings>> muscle_fields() {
  static const auto table = make_muscles();
  return table;
}

std::span<const Field<SpringSettings>> spring_fields() {
  static const auto table = make_springs();
  return table;
}

std::span<const Field<SpringKeySettings>> spring_key_fields() {
  static const auto table = make_spring_keys();
  return table;
}

std::span<const Field<ValueKeySettings>> activation_fields() {
  static const auto table =
      make_value_keys("activation", "fraction of the strength; linear between keys", {0, 1});
  return table;
}

}  // namespace sinew

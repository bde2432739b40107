// SPDX-License-Identifier: GPL-3.0-or-later
// What a scene says of the world around the body.
#include <sinew/settings/row.h>

namespace sinew {
namespace {

using namespace rows;

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
      field<O>("", "center", SINEW_AT(O, center), "m", "of a sphere or box", any, "none"),
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
  auto rows = make_region<P>("holds the particles in a box at rest: its least corner",
                             "or in a ball: its center");
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
                                  "or in a ball: its center"))
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
       make_region<M>("lies in a box at rest: its least corner", "or in a ball: its center"))
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

}  // namespace

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

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// The rows of lists whose entries name parts of the body: materials, and those of a testing
// machine, supports, loads and probes.
#include <sinew/settings/row.h>

namespace sinew {
namespace {

using namespace rows;

/// The keys of the part of the body in the member `part` of a list's entry.
template <class Owner>
void add_part(std::vector<Field<Owner>>& rows) {
  for (auto& row : {
           field<Owner>("", "low", SINEW_AT(Owner, part.region.low), "m",
                        "part of the body at rest, what is in all regions that are given; a box: "
                        "its lower corner",
                        any, "none"),
           field<Owner>("", "high", SINEW_AT(Owner, part.region.high), "m", "its upper corner", any,
                        "none"),
           field<Owner>("", "center", SINEW_AT(Owner, part.region.center), "m",
                        "or a ball: its center", any, "none"),
           field<Owner>("", "radius", SINEW_AT(Owner, part.region.radius), "m", "its radius",
                        positive, "none"),
           field<Owner>("", "point", SINEW_AT(Owner, part.point), "m",
                        "what is in front of a plane: any point on it", any, "none"),
           field<Owner>("", "normal", SINEW_AT(Owner, part.normal), "",
                        "its normal, into the region, of any length but 0", any, "none"),
           field<Owner>("", "axis", SINEW_AT(Owner, part.axis), "",
                        "what is around an axis: its direction, of any length but 0", any, "none"),
           field<Owner>("", "axis_point", SINEW_AT(Owner, part.axis_point), "m", "any point on it",
                        any, "none"),
           field<Owner>("", "axis_radius", SINEW_AT(Owner, part.axis_radius), "m",
                        "largest distance from it", positive, "none"),
           field<Owner>("", "component", SINEW_AT(Owner, part.component), "",
                        "one of several bodies: its number, as in body.vtu", not_negative, "none"),
           field<Owner>("", "facing", SINEW_AT(Owner, part.facing), "",
                        "the surface that faces this direction, of any length but 0", any, "none"),
           choice<Owner>(
               "", "facing_axis", SINEW_AT(Owner, part.facing_axis), {"none", "inward", "outward"},
               "the surface that looks at the axis, as a bore does, or away from it, as a "
               "shaft does"),
           field<Owner>("", "facing_angle", SINEW_AT(Owner, part.facing_angle), "degrees",
                        "largest angle between its normals and that direction", Range{0, 180}),
           may_lack("none", field<Owner>("", "bone", SINEW_AT(Owner, part.bone), "",
                                         "what is bound to this bone")),
           field<Owner>("", "ids", SINEW_AT(Owner, part.ids), "",
                        "particles by number, as in body.vtu", not_negative, "none"),
       })
    rows.push_back(row);
}

template <class Owner>
Field<Owner> pivot(std::string_view help) {
  return field<Owner>("", "pivot", SINEW_AT(Owner, pivot), "m", help);
}

std::vector<Field<LocalMaterialSettings>> make_materials() {
  using M = LocalMaterialSettings;
  std::vector<Field<M>> rows = {
      required(field<M>("", "name", SINEW_AT(M, name), "", "unique name of the material")),
      field<M>("", "young_modulus", SINEW_AT(M, young_modulus), "Pa",
               "Young's modulus of its part of the body; auto: material.young_modulus", positive),
      field<M>("", "poisson_ratio", SINEW_AT(M, poisson_ratio), "",
               "Poisson's ratio, in bonded_volume; auto: material.poisson_ratio", {0.25, 0.49}),
      field<M>("", "density", SINEW_AT(M, density), "kg/m^3", "density; auto: material.density",
               positive),
      field<M>("", "breaking_strain", SINEW_AT(M, breaking_strain), "",
               "strain at which its bonds break; auto: as in material", positive),
      field<M>("", "yield_strain", SINEW_AT(M, yield_strain), "",
               "strain of a bar that is pulled beyond which it flows; auto: as in material",
               positive),
  };
  add_part(rows);
  rows.push_back(path(may_lack("none", field<M>("", "mesh", SINEW_AT(M, part.mesh), "",
                                                "what is inside of a closed mesh, placed as the "
                                                "body's"))));
  return rows;
}

std::vector<Field<SupportSettings>> make_supports() {
  using S = SupportSettings;
  std::vector<Field<S>> rows = {
      required(field<S>("", "name", SINEW_AT(S, name), "", "unique name of the support")),
      choice<S>("", "hold", SINEW_AT(S, hold), {"x", "y", "xy", "z", "xz", "yz", "xyz"},
                "axes along which it prescribes the displacement, 0 without keys; along the others "
                "its part is free"),
      field<S>("", "hold_along", SINEW_AT(S, hold_along), "",
               "or one direction, of any length but 0, across which its part slides freely", any,
               "none"),
  };
  add_part(rows);
  rows.push_back(pivot<S>(
      "point of the axes of its rotation and of its moment; auto: the mean place of its part"));
  rows.push_back(choice<S>("", "interpolation", SINEW_AT(S, interpolation),
                           {"step", "linear", "smooth", "cubic"},
                           "interpolation between keys, as in motion.tracks"));
  return rows;
}

std::vector<Field<LoadSettings>> make_loads() {
  using L = LoadSettings;
  std::vector<Field<L>> rows = {
      required(field<L>("", "name", SINEW_AT(L, name), "", "unique name of the load")),
      field<L>("", "force", SINEW_AT(L, force), "N",
               "its sum; on a surface shared by area, else by mass", any, "none"),
      field<L>("", "traction", SINEW_AT(L, traction), "Pa",
               "or a force per area at rest, which keeps its direction", any, "none"),
      field<L>("", "pressure", SINEW_AT(L, pressure), "Pa",
               "or a pressure inward, which follows the surface", any, "none"),
      field<L>("", "gravity", SINEW_AT(L, gravity), "m/s^2", "or a force per mass", any, "none"),
  };
  add_part(rows);
  rows.push_back(pivot<L>("point of its moment; auto: the mean place of the load"));
  return rows;
}

std::vector<Field<ValueKeySettings>> make_factors() {
  using K = ValueKeySettings;
  return {
      required(field<K>("", "time", SINEW_AT(K, time), "s", "time of this key", not_negative)),
      required(field<K>("", "factor", SINEW_AT(K, value), "",
                        "factor on the load; linear between keys, 1 without any")),
  };
}

std::vector<Field<ProbeSettings>> make_probes() {
  using P = ProbeSettings;
  std::vector<Field<P>> rows = {
      required(field<P>("", "name", SINEW_AT(P, name), "", "unique name of the probe")),
      field<P>("", "at", SINEW_AT(P, at), "m",
               "a point that follows the particles near it, instead of a part", any, "none"),
  };
  add_part(rows);
  return rows;
}

}  // namespace

std::span<const Field<SupportSettings>> support_fields() {
  static const auto table = make_supports();
  return table;
}

std::span<const Field<LoadSettings>> load_fields() {
  static const auto table = make_loads();
  return table;
}

std::span<const Field<ValueKeySettings>> factor_fields() {
  static const auto table = make_factors();
  return table;
}

std::span<const Field<LocalMaterialSettings>> material_fields() {
  static const auto table = make_materials();
  return table;
}

std::span<const Field<ProbeSettings>> probe_fields() {
  static const auto table = make_probes();
  return table;
}

}  // namespace sinew

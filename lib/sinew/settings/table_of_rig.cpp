// SPDX-License-Identifier: GPL-3.0-or-later
// What a scene says of bones, their bindings and their motion.
#include <sinew/settings/row.h>

namespace sinew {
namespace {

using namespace rows;

std::vector<Field<BoneDefinition>> make_bones() {
  using B = BoneDefinition;
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

std::vector<Field<LimitDefinition>> make_limits() {
  using L = LimitDefinition;
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
      field<B>("", "center", SINEW_AT(B, center), "m", "of the ball that they lie in", any, "none"),
      field<B>("", "radius", SINEW_AT(B, radius), "m", "of that ball", positive, "none"),
  };
}

std::vector<Field<TrackDefinition>> make_tracks() {
  using T = TrackDefinition;
  return {
      required(field<T>("", "bone", SINEW_AT(T, bone), "", "name of the bone that moves")),
      choice<T>("", "interpolation", SINEW_AT(T, interpolation),
                {"step", "linear", "smooth", "cubic"},
                "between keys; smooth rests at each, cubic passes them without a jump of speed"),
      field<T>("", "order", SINEW_AT(T, order), "", "order of euler angles, such as xyz or zyx"),
  };
}

std::vector<Field<KeyDefinition>> make_keys() {
  using K = KeyDefinition;
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

}  // namespace

std::span<const Field<BoneDefinition>> bone_fields() {
  static const auto table = make_bones();
  return table;
}

std::span<const Field<LimitDefinition>> limit_fields() {
  static const auto table = make_limits();
  return table;
}

std::span<const Field<BoundSettings>> bound_fields() {
  static const auto table = make_bound();
  return table;
}

std::span<const Field<TrackDefinition>> track_fields() {
  static const auto table = make_tracks();
  return table;
}

std::span<const Field<KeyDefinition>> key_fields() {
  static const auto table = make_keys();
  return table;
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// The rows of bones, their binding and their motion.
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
               "position of its head at rest; auto: its parent's tail"),
      field<B>("", "tail", SINEW_AT(B, tail), "m",
               "position of its tail at rest; give this or length", any, "none"),
      field<B>("", "length", SINEW_AT(B, length), "m",
               "distance from head to tail, instead of tail", positive, "none"),
      field<B>("", "direction", SINEW_AT(B, direction), "",
               "its direction, for use with length, as a vector of any size; auto: its parent's "
               "direction"),
      field<B>("", "connected", SINEW_AT(B, connected), "",
               "whether it begins at its parent's tail; auto: if it has no head"),
      field<B>("", "roll", SINEW_AT(B, roll), "degrees",
               "rotation of its side axes about it; at 0 the first side axis is perpendicular to "
               "the bone and to the axis of x, y, z least aligned with it"),
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
               "largest angle between the bone and its rest direction relative to its parent",
               {0, 180}, "none"),
      field<L>("", "twist", SINEW_AT(L, twist), "degrees",
               "least and greatest twist about the bone itself", any, "none"),
  };
}

std::vector<Field<BoundSettings>> make_bound() {
  using B = BoundSettings;
  return {
      may_lack("none", field<B>("", "bone", SINEW_AT(B, bone), "",
                                "name of the only bone that holds these particles")),
      field<B>("", "ids", SINEW_AT(B, ids), "", "numbers of the particles, as in body.vtu",
               not_negative, "none"),
      field<B>("", "low", SINEW_AT(B, low), "m", "lower corner of the box that contains them", any,
               "none"),
      field<B>("", "high", SINEW_AT(B, high), "m", "upper corner of that box", any, "none"),
      field<B>("", "center", SINEW_AT(B, center), "m", "center of the ball that contains them", any,
               "none"),
      field<B>("", "radius", SINEW_AT(B, radius), "m", "radius of that ball", positive, "none"),
  };
}

std::vector<Field<TrackDefinition>> make_tracks() {
  using T = TrackDefinition;
  return {
      required(field<T>("", "bone", SINEW_AT(T, bone), "", "name of the bone that moves")),
      choice<T>("", "interpolation", SINEW_AT(T, interpolation),
                {"step", "linear", "smooth", "cubic"},
                "interpolation between keys; smooth rests at each key, cubic passes keys with "
                "continuous speed"),
      field<T>("", "order", SINEW_AT(T, order), "",
               "order of the Euler angles, such as xyz or zyx"),
  };
}

std::vector<Field<KeyDefinition>> make_keys() {
  using K = KeyDefinition;
  return {
      field<K>("", "time", SINEW_AT(K, time), "s", "time of this key", not_negative, "none"),
      field<K>("", "frame", SINEW_AT(K, frame), "",
               "frame of this key, from 0, instead of time; motion.frame_rate sets the rate",
               not_negative, "none"),
      field<K>("", "axis", SINEW_AT(K, axis), "", "axis of the rotation, in the parent's axes", any,
               "none"),
      field<K>("", "angle", SINEW_AT(K, angle), "degrees",
               "angle about the axis, of any size: keys about the same axis turn all the way", any,
               "none"),
      field<K>("", "euler", SINEW_AT(K, euler), "degrees",
               "rotation about the parent's x, y and z axes, instead of axis and angle", any,
               "none"),
      field<K>("", "quaternion", SINEW_AT(K, quaternion), "",
               "rotation as a unit quaternion [w, x, y, z], instead of axis and angle", any,
               "none"),
      field<K>("", "twist", SINEW_AT(K, twist), "degrees",
               "twist about the bone itself, of any size, after the rotation"),
      field<K>("", "translation", SINEW_AT(K, translation), "m",
               "displacement of the head from its position on the parent"),
      field<K>(
          "", "stretch", SINEW_AT(K, stretch), "",
          "factor on the bone's length; descendants move with the bone; particles follow within 7 "
          "% of "
          "the change, unless the bone is shorter than 40 radii (check says what they reach): its "
          "springs along it are raised for that, unless they are 0",
          positive),
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

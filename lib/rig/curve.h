// SPDX-License-Identifier: GPL-3.0-or-later
// Values that change over time: keys, and the way from each to the next.
//
// step holds a key until the next; linear goes straight on (slerp for rotations); smooth rests at
// every key (smoothstep); cubic passes the keys without a jump of speed: Hermite's polynomial.
// Where no tangents are given they follow from the neighbours (the parabola through three keys, as
// Catmull and Rom's for even times) and are zero at the first and the last key, where the curve
// begins and ends to hold; a cyclic curve takes its last key for its first one and goes on. Cubic
// rotations without tangents: Kim, Kim and Shin, "A general construction scheme for unit quaternion
// curves" (SIGGRAPH 1995), with angular velocities at the keys. With tangents: glTF 2.0, appendix
// C.
//
// Times are in seconds and ascend; before the first key and after the last a curve holds. A curve
// without keys is no curve: it must not be asked.
#pragma once

#include <vector>

#include "core/settings.h"
#include "rig/curve_piece.h"

namespace sinew {

/// Value: double or Vec3.
template <class Value>
struct Curve {
  Interpolation interpolation = Interpolation::linear;
  std::vector<double> times;  ///< s, ascending
  std::vector<Value> values;
  std::vector<Value> in, out;  ///< cubic: tangents before and after each key, 1/s; or empty
  bool cyclic = false;

  bool empty() const { return times.empty(); }
  CurvePiece<Value> piece_at(double time) const;
  CurveSample<Value> at(double time) const { return piece_at(time).at(time); }
};

extern template struct Curve<double>;
extern template struct Curve<Vec3>;

struct RotationCurve {
  Interpolation interpolation = Interpolation::linear;
  std::vector<double> times;  ///< s, ascending
  std::vector<Quat> values;   ///< unit quaternions of either sign
  /// turns[k]: the rotation vector that leads to key k from key k - 1, rad, of any size; its first
  /// is not used. Empty: the short way.
  std::vector<Vec3> turns;
  std::vector<Quat> in, out;  ///< cubic: tangents of the quaternion, 1/s; or empty
  bool cyclic = false;

  bool empty() const { return times.empty(); }
  RotationPiece piece_at(double time) const;
  RotationSample at(double time) const { return piece_at(time).at(time); }
};

}  // namespace sinew

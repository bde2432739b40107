// SPDX-License-Identifier: GPL-3.0-or-later
// Values that change over time: keys, and the interpolation between them.
//
//     const CurveSample<double> twist = curve.at(time);  // twist.value, twist.rate
//
// step holds a key until the next (up to rounding of times); linear interpolates (slerp for
// rotations); smooth stops at every key (smoothstep); cubic passes the keys with continuous speed:
// Hermite's polynomial. Tangents that are not given follow from the adjacent keys (the parabola
// through three keys, as Catmull and Rom's for equal intervals) and are zero at the first and the
// last key; in a cyclic curve the last key is the first one again. Cubic rotations without
// tangents: Kim, Kim and Shin, "A general construction scheme for unit quaternion curves" (SIGGRAPH
// 1995), with angular velocities at the keys. With tangents: glTF 2.0, appendix C.
//
// Times are in seconds and ascend; a curve is constant before the first key and after the last. A
// curve without keys must not be evaluated.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include <sinew/core/options.h>
#include <sinew/core/vector.h>

namespace sinew {

// A curve between two keys, prepared for many evaluations: what is the same for all of them is
// computed once. Before the first key and after the last a piece is constant.

template <class Value>
struct CurveSample {
  Value value, rate;  ///< rate per second, exact
};

struct RotationSample {
  Quat value;             ///< a unit quaternion
  Vec3 angular_velocity;  ///< in the coordinates in which the rotations are given, rad/s
};

/// When a piece is valid, and its parameter: s grows from 0 to 1 between its keys.
struct PieceTime {
  static constexpr double never = std::numeric_limits<double>::infinity();
  double begin = never, end = -never;  ///< s: for begin <= time < end
  double start = 0, speed = 0;         ///< s = (time - start) speed

  bool covers(double time) const { return begin <= time && time < end; }
  double s(double time) const { return (time - start) * speed; }
};

/// All numbers are interpolated by polynomials. Value: double or Vec3.
template <class Value>
struct CurvePiece {
  PieceTime time;
  std::array<Value, 4> c;  ///< c0 + c1 s + c2 s^2 + c3 s^3

  CurveSample<Value> at(double moment) const {
    const double s = time.s(moment);
    return {c[0] + s * (c[1] + s * (c[2] + s * c[3])),
            time.speed * (c[1] + s * (2 * c[2] + s * (3 * c[3])))};
  }
};

struct RotationPiece {
  enum class Form {
    turn,     ///< c0 a quaternion, c1 a rotation vector: c0, then progress(s) c1
    turns,    ///< c0 a quaternion, c1, c2, c3 rotation vectors, one after the other (Kim et al.)
    tangents  ///< c0 + c1 s + c2 s^2 + c3 s^3, normalized (glTF)
  };
  PieceTime time;
  Form form = Form::turn;
  /// progress[0] s + progress[1] s^2 + progress[2] s^3.
  std::array<double, 3> progress = {0, 0, 0};
  std::array<Eigen::Vector4d, 4> c;  ///< quaternions as x y z w

  RotationSample at(double moment) const;
};

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
  /// turns[k]: the rotation vector from key k - 1 to key k, rad, of any length; the first is
  /// unused. Empty: the shortest rotations.
  std::vector<Vec3> turns;
  std::vector<Quat> in, out;  ///< cubic: tangents of the quaternion, 1/s; or empty
  bool cyclic = false;

  bool empty() const { return times.empty(); }
  RotationPiece piece_at(double time) const;
  RotationSample at(double time) const { return piece_at(time).at(time); }
};

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// Values that change over time: keys, and the way from each to the next.
//
// step holds a key until the next; linear goes straight on (slerp for rotations); smooth rests at
// every key (smoothstep); cubic passes the keys without a jump of speed: Hermite's polynomial.
// Where no tangents are given they follow from the neighbors (the parabola through three keys, as
// Catmull and Rom's for even times) and are zero at the first and the last key, where the curve
// begins and ends to hold; a cyclic curve takes its last key for its first one and goes on. Cubic
// rotations without tangents: Kim, Kim and Shin, "A general construction scheme for unit quaternion
// curves" (SIGGRAPH 1995), with angular velocities at the keys. With tangents: glTF 2.0, appendix
// C.
//
// Times are in seconds and ascend; before the first key and after the last a curve holds. A curve
// without keys is no curve: it must not be asked.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include <sinew/core/options.h>
#include <sinew/core/vector.h>

namespace sinew {

// A curve from one key to the next, ready to be asked often: what does not change between two keys
// is found once. Before the first key and after the last a piece holds.

template <class Value>
struct CurveSample {
  Value value, rate;  ///< rate per second, exact
};

struct RotationSample {
  Quat value;             ///< a unit quaternion
  Vec3 angular_velocity;  ///< in the directions the rotations are given in, rad/s
};

/// When a piece is to be used, and how far on it is: s grows from 0 to 1 between its keys.
struct PieceTime {
  static constexpr double never = std::numeric_limits<double>::infinity();
  double begin = never, end = -never;  ///< s: for begin <= time < end
  double start = 0, speed = 0;         ///< s = (time - start) speed

  bool covers(double time) const { return begin <= time && time < end; }
  double s(double time) const { return (time - start) * speed; }
};

/// Every interpolation of numbers is a polynomial. Value: double or Vec3.
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
    turn,     ///< c0 a quaternion, c1 the vector by which it turns: by progress(s) of it
    turns,    ///< c0 a quaternion, c1, c2, c3 vectors of turns, one after the other (Kim et al.)
    tangents  ///< c0 + c1 s + c2 s^2 + c3 s^3, made a unit quaternion (glTF)
  };
  PieceTime time;
  Form form = Form::turn;
  std::array<double, 3> progress = {0, 0,
                                    0};  ///< progress[0] s + progress[1] s^2 + progress[2] s^3
  std::array<Eigen::Vector4d, 4> c;      ///< quaternions as x y z w

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

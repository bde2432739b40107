// SPDX-License-Identifier: GPL-3.0-or-later
// A curve from one key to the next, ready to be asked often: what does not change between two keys
// is found once. Before the first key and after the last a piece holds.
#pragma once

#include <array>
#include <limits>

#include "core/vector.h"

namespace sinew {

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
    turn,     ///< c0 a quaternion, c1 the vector by which it turns: by way(s) of it
    turns,    ///< c0 a quaternion, c1, c2, c3 vectors of turns, one after the other (Kim et al.)
    tangents  ///< c0 + c1 s + c2 s^2 + c3 s^3, made a unit quaternion (glTF)
  };
  PieceTime time;
  Form form = Form::turn;
  std::array<double, 3> way = {0, 0, 0};  ///< way[0] s + way[1] s^2 + way[2] s^3
  std::array<Eigen::Vector4d, 4> c;       ///< quaternions as x y z w

  RotationSample at(double moment) const;
};

}  // namespace sinew

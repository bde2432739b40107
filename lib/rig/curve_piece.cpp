// SPDX-License-Identifier: GPL-3.0-or-later
#include "rig/curve_piece.h"

#include "rig/rotation_vector.h"

namespace sinew {
namespace {

using Vec4 = Eigen::Vector4d;

RotationSample by_turn(const RotationPiece& piece, double s) {
  const auto& [linear, square, cube] = piece.way;
  const Vec3 turn = piece.c[1].head<3>();
  const double way = s * (linear + s * (square + s * cube));
  const double rate = piece.time.speed * (linear + s * (2 * square + s * (3 * cube)));
  return {rotation_by(way * turn) * Quat(piece.c[0]), rate * turn};
}

RotationSample by_turns(const RotationPiece& piece, double s) {
  const double r = 1 - s;
  const Vec3 one = piece.c[1].head<3>(), two = piece.c[2].head<3>(), three = piece.c[3].head<3>();
  const Quat first = rotation_by((1 - r * r * r) * one),
             second = rotation_by(s * s * (3 - 2 * s) * two),
             third = rotation_by(s * s * s * three);
  const Vec3 rate = 3 * s * s * three + third * (6 * s * r * two + second * (3 * r * r * one));
  return {third * second * first * Quat(piece.c[0]), piece.time.speed * rate};
}

RotationSample by_tangents(const RotationPiece& piece, double s) {
  const auto& c = piece.c;
  const Vec4 mixed = c[0] + s * (c[1] + s * (c[2] + s * c[3]));
  const Vec4 slope = piece.time.speed * (c[1] + s * (2 * c[2] + s * (3 * c[3])));
  const double size = mixed.norm();
  if (size == 0) return {Quat(c[0]).normalized(), Vec3::Zero()};
  const Vec4 unit = mixed / size;
  const Quat value(unit), rate(Vec4((slope - unit * unit.dot(slope)) / size));
  return {value, 2 * (rate * value.conjugate()).vec()};
}

}  // namespace

RotationSample RotationPiece::at(double moment) const {
  const double s = time.s(moment);
  if (form == Form::turns) return by_turns(*this, s);
  return form == Form::turn ? by_turn(*this, s) : by_tangents(*this, s);
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// Rotations as vectors: the axis times the angle, rad. A vector may be longer than pi.
#pragma once

#include <cmath>

#include "core/vector.h"

namespace sinew {

/// Of the two vectors of a rotation the shorter one, up to pi long.
inline Vec3 rotation_vector(Quat rotation) {
  if (rotation.w() < 0) rotation.coeffs() *= -1;
  const double sine = rotation.vec().norm();
  if (sine == 0) return Vec3::Zero();
  return rotation.vec() * (2 * std::atan2(sine, rotation.w()) / sine);
}

inline Quat rotation_by(const Vec3& vector) {
  const double angle = vector.norm();
  return angle == 0 ? Quat::Identity() : Quat(Eigen::AngleAxisd(angle, vector / angle));
}

}  // namespace sinew

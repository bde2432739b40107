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

/// Between near keys angles are small, where a few terms of the series say all to the last digit.
inline Quat rotation_by(const Vec3& vector) {
  const double x2 = vector.squaredNorm() / 4;  // half the angle, squared
  if (x2 < 1.0 / 64) {
    const double sinc =
        1 + x2 * (-1.0 / 6 + x2 * (1.0 / 120 + x2 * (-1.0 / 5040 + x2 * (1.0 / 362880))));
    const double cosine =
        1 + x2 * (-0.5 +
                  x2 * (1.0 / 24 + x2 * (-1.0 / 720 + x2 * (1.0 / 40320 - x2 * (1.0 / 3628800)))));
    const Vec3 sine = sinc / 2 * vector;
    return {cosine, sine.x(), sine.y(), sine.z()};
  }
  const double angle = vector.norm();
  return Quat(Eigen::AngleAxisd(angle, vector / angle));
}

}  // namespace sinew

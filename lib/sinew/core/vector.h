// SPDX-License-Identifier: GPL-3.0-or-later
// Vectors, matrices, rigid frames and rotations. Meters, seconds, kilograms but where stated.
//
//     const Vec3 now = carried(point, rest_frame, present_frame);
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <vector>

namespace sinew {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;
using Points = std::vector<Vec3>;  // n x 3

inline constexpr double pi = 3.14159265358979323846;

/// The matrix of a cross product: cross_matrix(a) b = a x b.
inline Mat3 cross_matrix(const Vec3& a) {
  Mat3 matrix;
  matrix << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return matrix;
}

inline double radians(double degrees) { return degrees * (pi / 180); }
inline double degrees(double radians) { return radians * (180 / pi); }

/// Whether a number from outside can be computed with: finite, and its square and cube as well.
inline bool is_computable(double value) { return std::abs(value) < 1e100; }
inline bool is_computable(const Vec3& value) { return (value.array().abs() < 1e100).all(); }

/// An axis-aligned box; empty (low > high) until a point is added.
using Box = Eigen::AlignedBox3d;

// A rigid frame: a place and an orientation.

/// Maps local x to origin + rotation x.
struct RigidFrame {
  Vec3 origin = Vec3::Zero();        ///< m
  Mat3 rotation = Mat3::Identity();  ///< columns are the frame's axes
};

/// The present position of a point fixed to a frame, at `point` when the frame was at `rest`.
inline Vec3 carried(const Vec3& point, const RigidFrame& rest, const RigidFrame& now) {
  return now.origin + now.rotation * (rest.rotation.transpose() * (point - rest.origin));
}

// Rotation vectors: axis times angle, rad. A vector may be longer than pi.

/// The shorter of the two vectors of a rotation, up to pi long.
inline Vec3 rotation_vector(Quat rotation) {
  if (rotation.w() < 0) rotation.coeffs() *= -1;
  const double sine = rotation.vec().norm();
  if (sine == 0) return Vec3::Zero();
  return rotation.vec() * (2 * std::atan2(sine, rotation.w()) / sine);
}

/// Angles between close keys are small: a few terms of the series are exact to the last digit.
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

// SPDX-License-Identifier: GPL-3.0-or-later
// The vectors and matrices every room speaks in. Metres, seconds, kilograms unless said otherwise.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <vector>

namespace sinew {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;
using Points = std::vector<Vec3>;  // n x 3

inline constexpr double pi = 3.14159265358979323846;

inline double radians(double degrees) { return degrees * (pi / 180); }
inline double degrees(double radians) { return radians * (180 / pi); }

/// An axis-aligned box; empty (low > high) until a point is added.
using Box = Eigen::AlignedBox3d;

}  // namespace sinew

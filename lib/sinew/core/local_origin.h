// SPDX-License-Identifier: GPL-3.0-or-later
// The point to which coordinates are relative where they are held in single precision: pictures,
// the report's playback, point caches, glTF. Near the origin it is the origin itself.
//
//     const Vec3 origin = local_origin(bounds(surface.points));
//     const auto x = static_cast<float>(point.x() - origin.x());
#pragma once

#include <cmath>

#include <sinew/core/vector.h>

namespace sinew {

/// A point near `box` (m), zero where its center lies within 128 diagonals of 0 or the box has no
/// size. A multiple of a power of two that exceeds the diagonal: differences from it are exact, and
/// up to 1e7 diagonals single precision holds it.
inline Vec3 local_origin(const Box& box) {
  constexpr double near = 128;  // diagonals: there single precision holds 1e-5 of one
  if (box.isEmpty()) return Vec3::Zero();
  const Vec3 center = box.center();
  const double size = box.diagonal().norm();
  if (!(size > 0 && center.norm() > near * size) || !center.allFinite()) return Vec3::Zero();
  const double unit = std::ldexp(1.0, std::ilogb(size) + 1);
  return (unit * (center / unit).array().round()).matrix();
}

}  // namespace sinew

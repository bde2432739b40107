// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/local_origin.h>

#include <cmath>

namespace sinew {

Vec3 local_origin(const Box& box) {
  constexpr double near = 128;  // diagonals: there single precision holds 1e-5 of one
  if (box.isEmpty()) return Vec3::Zero();
  const Vec3 center = box.center();
  const double size = box.diagonal().norm();
  if (!(size > 0 && center.norm() > near * size) || !center.allFinite()) return Vec3::Zero();
  const double unit = std::ldexp(1.0, std::ilogb(size) + 1);
  return (unit * (center / unit).array().round()).matrix();
}

}  // namespace sinew

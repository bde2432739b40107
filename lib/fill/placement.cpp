// SPDX-License-Identifier: GPL-3.0-or-later
#include "fill/placement.h"

#include <cmath>

namespace sinew {
namespace {

/// A number near the middle of low .. high whose difference to any double between them is exact; 0
/// where they are near 0 already.
double exact_shift(double low, double high) {
  const double nearest = std::min(std::abs(low), std::abs(high)), size = high - low;
  if (low * high <= 0 || nearest < 2 * size) return 0;
  const double step = std::ldexp(1.0, std::ilogb(nearest) - 52);  // all of them are multiples
  return std::round((low + size / 2) / step) * step;
}

}  // namespace

Placement::Placement(const Points& points, const Mat3& turn)
    : turn_(turn), turned_(turn != Mat3::Identity()) {
  const Box box = bounds(points);
  for (int axis = 0; axis < 3; ++axis) shift_[axis] = exact_shift(box.min()[axis], box.max()[axis]);
}

Triangles Placement::to_lattice(Triangles surface) const {
  for (Vec3& point : surface.points) point = to_lattice(point);
  return surface;
}

Vec3 Placement::to_lattice(const Vec3& point) const {
  const Vec3 near = point - shift_;
  return turned_ ? Vec3(turn_.transpose() * near) : near;
}

Vec3 Placement::from_lattice(const Vec3& site) const {
  return (turned_ ? Vec3(turn_ * site) : site) + shift_;
}

}  // namespace sinew

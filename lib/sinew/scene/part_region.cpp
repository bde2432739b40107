// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/part_region.h>

#include <cmath>

namespace sinew {
namespace {

/// Vector from a part's axis to a place, m.
Vec3 from_axis(const PartSettings& part, const Vec3& place) {
  const Vec3 along = part.axis->normalized(), from = place - *part.axis_point;
  return from - from.dot(along) * along;
}

}  // namespace

bool is_in_region(const PartSettings& part, const Vec3& place, double slack) {
  const RegionSettings& region = part.region;
  const Vec3 wide = Vec3::Constant(slack);
  if (region.low && !Box(*region.low - wide, *region.high + wide).contains(place)) return false;
  if (region.center && !((place - *region.center).norm() <= *region.radius + slack)) return false;
  if (part.point && !((place - *part.point).dot(*part.normal) >= -slack * part.normal->norm()))
    return false;
  return !part.axis_radius || from_axis(part, place).norm() <= *part.axis_radius + slack;
}

bool faces_as(const PartSettings& part, const Vec3& area, const Vec3& center) {
  constexpr double slack = 1e-9;  // faces at exactly that angle are in
  const double least = (std::cos(radians(part.facing_angle)) - slack) * area.norm();
  const auto looks = [&](const Vec3& direction) {
    return area.dot(direction.normalized()) >= least;
  };
  if (part.facing && !looks(*part.facing)) return false;
  if (part.facing_axis == AxisSide::none) return true;
  const Vec3 outward = from_axis(part, center);
  return looks(part.facing_axis == AxisSide::outward ? outward : Vec3(-outward));
}

}  // namespace sinew

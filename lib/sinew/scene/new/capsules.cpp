// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/new/capsules.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <sinew/mesh/clean.h>
#include <sinew/mesh/solids.h>
#include <sinew/mesh/winding.h>
#include <sinew/repair/repair.h>
#include <sinew/volume/implicit_surface.h>

namespace sinew {
namespace {

// Edges of the honeycomb, in sides: its longest, sqrt(2) of them, span no gap as wide as a side.
constexpr double edge = 0.7;

double distance_to(const Capsule& capsule, const Vec3& point) {
  const Vec3 along = capsule.to - capsule.from, offset = point - capsule.from;
  const double square = along.squaredNorm();
  const double s = square > 0 ? std::clamp(offset.dot(along) / square, 0.0, 1.0) : 0;
  return (offset - s * along).norm() - capsule.radius;
}

Box box_around(const std::vector<Capsule>& capsules) {
  Box box;
  for (const Capsule& one : capsules)
    for (const Vec3& end : {one.from, one.to})
      for (const double by : {-one.radius, one.radius}) box.extend(end + Vec3::Constant(by));
  return box;
}

/// Whether a skin is around all parts.
bool holds(const Triangles& skin, const std::vector<Capsule>& capsules) {
  if (skin.faces.empty()) return false;
  const Winding winding = winding_of(clean(soup_of(skin)));
  return std::all_of(capsules.begin(), capsules.end(), [&](const Capsule& one) {
    const auto is_inside = [&](double s) {
      return winding.around(one.from + s * (one.to - one.from)).value_or(0) > 0;
    };
    return is_inside(0) && is_inside(0.5) && is_inside(1);
  });
}

Triangles meshed(const std::vector<Capsule>& capsules, double side) {
  if (capsules.empty()) return {};
  return implicit_surface(
      [&](const Vec3& point) {
        double least = std::numeric_limits<double>::infinity();
        for (const Capsule& one : capsules) least = std::min(least, distance_to(one, point));
        return least;
      },
      box_around(capsules), edge * side);
}

}  // namespace

Triangles skin_around(const std::vector<Capsule>& capsules, double side) {
  Triangles skin = meshed(capsules, side);
  if (holds(skin, capsules)) return skin;
  Triangles all;
  for (const Capsule& one : capsules) append(capsule_between(one.from, one.to, one.radius), all);
  return wrap(all, side);
}

}  // namespace sinew

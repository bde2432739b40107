// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/mesh/solids.h>

#include <algorithm>
#include <cmath>

#include <sinew/core/decompositions.h>

namespace sinew {
namespace {

constexpr int faces_around = 48, faces_of_limb = 24;  // around the axis

/// A ring around the axis: its radius and height; radius 0 is a point.
struct Ring {
  double radius, height;
};

std::vector<Ring> half_ball(double low, double height, bool upper, int around) {
  const int quarter = around / 4;  // rings from a pole to the equator
  std::vector<Ring> rings;
  for (int i = 0; i <= quarter; ++i) {
    const double angle = pi / 2 * (upper ? i : quarter - i) / quarter;
    const double radius = i == (upper ? quarter : 0) ? 0 : std::cos(angle);
    rings.push_back({radius, low + height * (upper ? std::sin(angle) : 1 - std::sin(angle))});
  }
  return rings;
}

std::vector<Ring> rings_of(SolidShape shape, const Vec3& size, int around) {
  const double high = size.z();
  if (shape == SolidShape::cylinder) return {{0, 0}, {1, 0}, {1, high}, {0, high}};
  const double end =
      shape == SolidShape::sphere ? high / 2 : std::min({size.x() / 2, size.y() / 2, high / 2});
  std::vector<Ring> rings = half_ball(0, end, false, around);
  const std::vector<Ring> upper = half_ball(high - end, end, true, around);
  const bool meet = high <= 2 * end;
  rings.insert(rings.end(), upper.begin() + (meet ? 1 : 0), upper.end());
  return rings;
}

/// First and last ring are points.
Triangles revolved(const std::vector<Ring>& rings, double x, double y, int around) {
  Triangles all;
  for (const Ring& ring : rings)
    for (int j = 0; j < (ring.radius > 0 ? around : 1); ++j) {
      const double angle = 2 * pi * j / around;
      all.points.emplace_back(x * ring.radius * std::cos(angle), y * ring.radius * std::sin(angle),
                              ring.height);
    }
  const int last = static_cast<int>(all.points.size()) - 1;
  const int between = static_cast<int>(rings.size()) - 3;
  for (int j = 0; j < around; ++j) {
    const int next = (j + 1) % around;
    all.faces.push_back({0, 1 + next, 1 + j});
    for (int i = 0, low = 1; i < between; ++i, low += around) {
      all.faces.push_back({low + j, low + next, low + around + next});
      all.faces.push_back({low + j, low + around + next, low + around + j});
    }
    all.faces.push_back({last, last - around + j, last - around + next});
  }
  return all;
}

Triangles box_of(const Vec3& size) {
  Triangles box;
  for (int i = 0; i < 8; ++i)
    box.points.emplace_back((i & 1 ? 0.5 : -0.5) * size.x(), (i & 2 ? 0.5 : -0.5) * size.y(),
                            i & 4 ? size.z() : 0.0);
  box.faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
               {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return box;
}

}  // namespace

Triangles solid(SolidShape shape, const Vec3& size) {
  if (shape == SolidShape::box) return box_of(size);
  return revolved(rings_of(shape, size, faces_around), size.x() / 2, size.y() / 2, faces_around);
}

Triangles capsule_between(const Vec3& from, const Vec3& to, double radius) {
  const Vec3 along = to - from;
  const Vec3 size(2 * radius, 2 * radius, along.norm() + 2 * radius);
  Triangles capsule =
      revolved(rings_of(SolidShape::capsule, size, faces_of_limb), radius, radius, faces_of_limb);
  const Quat turn = shortest_rotation(Vec3::UnitZ(), along.normalized());
  for (Vec3& point : capsule.points) point = from + turn * (point - Vec3(0, 0, radius));
  return capsule;
}

void append(const Triangles& other, Triangles& all) {
  const int first = static_cast<int>(all.points.size());
  all.points.insert(all.points.end(), other.points.begin(), other.points.end());
  for (const auto& [a, b, c] : other.faces) all.faces.push_back({first + a, first + b, first + c});
}

}  // namespace sinew

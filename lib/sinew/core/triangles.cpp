// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/triangles.h>

namespace sinew {
namespace {

Vec3 doubled_area_vector(const Triangles& surface, const std::array<int, 3>& face) {
  const Vec3& a = surface.points[face[0]];
  return (surface.points[face[1]] - a).cross(surface.points[face[2]] - a);
}

}  // namespace

double volume(const Triangles& surface) {
  if (surface.faces.empty()) return 0;
  const Vec3 center = bounds(surface.points).center();  // keeps digits far from the origin
  double sum = 0;
  for (const auto& [a, b, c] : surface.faces) {
    const Vec3 from_b = surface.points[b] - center;
    sum += (surface.points[a] - center).dot(from_b.cross(surface.points[c] - center));
  }
  return sum / 6;
}

double area(const Triangles& surface) {
  double sum = 0;
  for (const auto& face : surface.faces) sum += doubled_area_vector(surface, face).norm() / 2;
  return sum;
}

Box bounds(const Points& points) {
  Box box;
  for (const Vec3& point : points) box.extend(point);
  return box;
}

Points point_normals(const Triangles& surface) {
  Points normals(surface.points.size(), Vec3::Zero());
  for (const auto& face : surface.faces) {
    const Vec3 normal = doubled_area_vector(surface, face);
    for (const int corner : face) normals[corner] += normal;
  }
  for (Vec3& normal : normals) {
    const double length = normal.norm();
    if (length > 0) normal /= length;
  }
  return normals;
}

}  // namespace sinew

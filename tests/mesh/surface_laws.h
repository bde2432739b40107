// SPDX-License-Identifier: GPL-3.0-or-later
// What holds for every cleaned surface, computed the long way.
#pragma once

#include <cmath>
#include <map>
#include <tuple>

#include <sinew/mesh/surface.h>

namespace sinew::laws {

/// Edges that faces and caps together go along more often in one direction than in the other;
/// points are the same where their coordinates are.
inline std::size_t border_with_caps(const Surface& surface) {
  using Place = std::tuple<double, double, double>;
  std::map<std::pair<Place, Place>, int> count;
  for (const Triangles* part : {&surface.triangles, &surface.caps})
    for (const auto& face : part->faces)
      for (int side = 0; side < 3; ++side) {
        const Vec3 &p = part->points[face[side]], &q = part->points[face[(side + 1) % 3]];
        const Place from(p.x(), p.y(), p.z()), to(q.x(), q.y(), q.z());
        if (from != to)  // a hole's middle may be one of its points
          count[std::minmax(from, to)] += from < to ? 1 : -1;
      }
  std::size_t open = 0;
  for (const auto& [edge, net] : count) open += net != 0;
  return open;
}

/// Sum of solid angles (van Oosterom and Strackee 1983) over 4 pi.
inline double winding_number(const Triangles& triangles, const Vec3& from) {
  double angle = 0;
  for (const auto& [i, j, k] : triangles.faces) {
    const Vec3 a = triangles.points[i] - from, b = triangles.points[j] - from,
               c = triangles.points[k] - from;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    const double below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    angle += 2 * std::atan2(a.dot(b.cross(c)), below);
  }
  return angle / (4 * pi);
}

/// Volume of the faces with their caps, m^3.
inline double capped_volume(const Surface& surface) {
  Triangles all = surface.triangles;
  const int offset = static_cast<int>(all.points.size());
  all.points.insert(all.points.end(), surface.caps.points.begin(), surface.caps.points.end());
  for (const auto& [a, b, c] : surface.caps.faces)
    all.faces.push_back({a + offset, b + offset, c + offset});
  return volume(all);
}

}  // namespace sinew::laws

// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/surface.h"

namespace sinew {

std::vector<double> component_volumes(const Surface& surface) {
  std::vector<double> sums(surface.components);
  const Points& points = surface.triangles.points;
  const Vec3 middle = bounds(points).center();  // keeps digits far from the origin
  for (std::size_t i = 0; i < surface.triangles.faces.size(); ++i) {
    const auto& [a, b, c] = surface.triangles.faces[i];
    const Vec3 p = points[a] - middle, q = points[b] - middle, r = points[c] - middle;
    sums[surface.component[i]] += p.dot(q.cross(r)) / 6;
  }
  return sums;
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/flat_faces.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace sinew {

std::vector<bool> flat_faces(const Triangles& surface) {
  using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
  const auto point = [&](int i) {
    const Vec3& p = surface.points[i];
    return Point(p.x(), p.y(), p.z());
  };
  std::vector<bool> flat(surface.faces.size());
  for (std::size_t i = 0; i < flat.size(); ++i) {
    const auto& [a, b, c] = surface.faces[i];
    flat[i] = CGAL::collinear(point(a), point(b), point(c));
  }
  return flat;
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// Area and volume, face by face.
#pragma once

#include "core/triangles.h"

namespace sinew {

/// Area times normal, m^2.
inline Vec3 area_vector(const Triangles& surface, const std::array<int, 3>& face) {
  const Vec3& a = surface.points[face[0]];
  return (surface.points[face[1]] - a).cross(surface.points[face[2]] - a) / 2;
}

/// m^2.
inline double face_area(const Triangles& surface, const std::array<int, 3>& face) {
  return area_vector(surface, face).norm();
}

/// Of the tetrahedron between a face and a place, m^3: positive where the face turns its back to
/// it.
inline double volume_below(const Triangles& surface, const std::array<int, 3>& face,
                           const Vec3& place) {
  const Vec3 a = surface.points[face[0]] - place, b = surface.points[face[1]] - place,
             c = surface.points[face[2]] - place;
  return a.dot(b.cross(c)) / 6;
}

/// What rounding may leave of the volume of a flat body, m^3.
inline double volume_rounding(double area, const Box& box) {
  return 1e-13 * area * box.diagonal().norm();
}

}  // namespace sinew

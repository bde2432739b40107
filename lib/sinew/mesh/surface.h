// SPDX-License-Identifier: GPL-3.0-or-later
// A surface as the fill takes it: triangles that agree on what is outside as far as they can, and
// what closes them where they do not.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <sinew/core/triangles.h>
#include <sinew/mesh/border.h>
#include <sinew/mesh/clean.h>

namespace sinew {

// What closes holes.

/// Faces over copies of the loop's points that go along its edges in the other direction. Each halves
/// what is left of the loop: most of them are small and near the border. Appends to `caps`.
void add_cap(const Loop& loop, const Points& points, Triangles& caps);

/// All of them, in the order of the loops.
Triangles caps_of(std::span<const Loop> loops, const Points& points);

/// Where the surface ends. Each edge counts the directions its faces go along it, forward minus
/// backward; where that is not 0 the surface is open. Such edges form closed loops: the holes.
struct Border {
  std::size_t holes = 0;          ///< loops
  std::size_t edges = 0;          ///< open edges
  std::size_t crowded_edges = 0;  ///< edges of three or more faces, open or not
  double length = 0;              ///< of the open edges, m
};

/// The faces of a body point outward (counter-clockwise seen from outside), those of a cavity into
/// the cavity. They may cut each other, and overlap.
struct Surface {
  Triangles triangles;
  std::vector<bool> turned;    ///< per face: whether it points against the file
  std::vector<int> component;  ///< per face: faces joined by edges, numbered by their first face
  int components = 0;
  /// Faces that close every hole, with points of their own, so that triangles and caps together
  /// have no border. They fill nothing; they are a means to compute winding numbers.
  Triangles caps;
  Border border;
  CleaningCounts cleaning;
  double seconds_reading = 0, seconds_cleaning = 0;

  bool closed() const { return caps.faces.empty(); }
};

/// The volume that each component encloses, m^3; negative for cavities. Of open surfaces without
/// the volume behind their caps.
std::vector<double> component_volumes(const Surface& surface);

// Area and volume, face by face.

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

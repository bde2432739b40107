// SPDX-License-Identifier: GPL-3.0-or-later
// A surface as the fill takes it: triangles that agree on what is outside as far as they can, and
// what closes them where they do not.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include <sinew/core/triangles.h>
#include <sinew/mesh/border.h>

namespace sinew {

// What closes holes.

/// Faces over copies of the loop's points that go along its edges in the other direction. Each
/// halves what is left of the loop: most of them are small and near the border. Appends to `caps`.
void add_cap(const Loop& loop, const Points& points, Triangles& caps);

/// All of them, in the order of the loops.
Triangles caps_of(std::span<const Loop> loops, const Points& points);

// What cleaning and repairing a mesh came to, and what each count is called wherever it is told.

struct CleaningCounts {
  std::size_t points_read = 0;
  std::size_t polygons_read = 0;
  std::size_t polygons_cut = 0;     ///< polygons of four or more corners, cut into triangles
  std::size_t points_merged = 0;    ///< points equal to, or within the weld distance of, another
  std::size_t points_unused = 0;    ///< points of no face, left out
  std::size_t faces_collapsed = 0;  ///< faces left out because two of their corners are one point
  std::size_t faces_doubled = 0;    ///< faces left out because an earlier one has the same corners
  std::size_t faces_flat = 0;       ///< faces without area, kept: they may close the surface
  std::size_t faces_turned = 0;     ///< faces whose direction was reversed
  std::size_t holes_closed = 0;     ///< by faces_added new faces, where that was asked for
  std::size_t faces_added = 0;
  std::size_t faces_wrapped = 0;  ///< of the skin that replaced the mesh, where asked for
  std::size_t edges_twisted = 0;  ///< edges whose two faces cannot agree (as on a Moebius strip)
};

/// A count as reports name it.
struct NamedCount {
  enum class Of { file, cleaning, repair };  ///< repairs are done only when asked for

  std::string_view name;
  std::size_t CleaningCounts::*count;
  Of of;
};

/// All counts, in the order in which they are told.
std::span<const NamedCount> cleaning_counts();

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

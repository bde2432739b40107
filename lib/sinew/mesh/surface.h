// SPDX-License-Identifier: GPL-3.0-or-later
// The surface of a body, as the fill takes it: triangles oriented outward where that is possible,
// caps that close its holes, and the counts of cleaning.
//
//     const bool closed = surface.closed();
//     const std::vector<double> volumes = component_volumes(surface);
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sinew/core/triangles.h>
#include <sinew/mesh/border.h>

namespace sinew {

// Caps, which close holes.

/// Adds to `caps` faces on copies of the loop's points, traversing its edges in the other
/// direction. The loop is halved recursively, so that most faces are small and near the border.
void add_cap(const Loop& loop, const Points& points, Triangles& caps);

/// All of them, in the order of the loops.
Triangles caps_of(std::span<const Loop> loops, const Points& points);

// The counts of cleaning and repairing a mesh, and their names in reports.

struct CleaningCounts {
  std::size_t points_read = 0;
  std::size_t polygons_read = 0;
  std::size_t polygons_cut = 0;     ///< polygons of four or more corners, cut into triangles
  std::size_t points_merged = 0;    ///< points equal to, or within the weld distance of, another
  std::size_t points_unused = 0;    ///< points of no face, left out
  std::size_t faces_collapsed = 0;  ///< faces left out because two of their corners are one point
  std::size_t faces_doubled = 0;    ///< faces left out because an earlier one has the same corners
  std::size_t faces_shared = 0;     ///< pairs of opposite faces between touching solids, left out
  std::size_t faces_flat = 0;       ///< faces without area, kept: they may close the surface
  std::size_t faces_turned = 0;     ///< faces whose direction was reversed
  std::size_t holes_closed = 0;     ///< holes closed by faces_added new faces, where asked for
  std::size_t faces_added = 0;
  std::size_t faces_wrapped = 0;  ///< faces of the skin that replaced the mesh, where asked for
  std::size_t edges_twisted = 0;  ///< edges of two faces that cannot agree (on a Moebius strip)
};

/// A count and its name in reports.
struct NamedCount {
  enum class Of { file, cleaning, repair };  ///< repairs are done only when asked for

  std::string_view name;
  std::size_t CleaningCounts::*count;
  Of of;
  std::string_view unit = {};
};

/// All counts, in the order of reports.
std::span<const NamedCount> cleaning_counts();

/// The faces that touching solids share, once each, on points of their own. They bound nothing.
struct Walls {
  Triangles triangles;
  std::vector<std::array<int, 2>> component;  ///< per face: behind it, before it
};

/// The faces of a body point outward (counter-clockwise seen from outside), those of a cavity into
/// the cavity. Faces may intersect, and bodies overlap.
struct Surface {
  Triangles triangles;
  std::vector<bool> turned;    ///< per face: whether it is reversed with respect to the file
  std::vector<int> component;  ///< per face: faces joined by edges, numbered by their first face
  int components = 0;          ///< count; walls part them
  Walls walls;
  /// Faces that close every hole, with points of their own, so that triangles and caps together
  /// have no border. They serve to compute winding numbers and bound nothing.
  Triangles caps;
  Border border;
  CleaningCounts cleaning;
  std::vector<std::size_t> first_face = {};  ///< first face of each joined mesh; empty: one mesh
  std::string warning;                       ///< warning of the reader; "": none
  double seconds_reading = 0, seconds_cleaning = 0;

  bool closed() const { return caps.faces.empty(); }
};

/// Several meshes as one, in their order, with the sums of their counts.
Surface joined(std::vector<Surface> parts);

/// The volume that each component and its walls enclose, m^3; negative for cavities. For open
/// surfaces it does not include the volume behind their caps.
std::vector<double> component_volumes(const Surface& surface);

// Area and volume of single faces.

/// Area times normal, m^2.
inline Vec3 area_vector(const Triangles& surface, const std::array<int, 3>& face) {
  const Vec3& a = surface.points[face[0]];
  return (surface.points[face[1]] - a).cross(surface.points[face[2]] - a) / 2;
}

/// m^2.
inline double face_area(const Triangles& surface, const std::array<int, 3>& face) {
  return area_vector(surface, face).norm();
}

/// Returns the volume of the tetrahedron of a face and a point, m^3: positive where the point is
/// behind the face.
inline double volume_below(const Triangles& surface, const std::array<int, 3>& face,
                           const Vec3& place) {
  const Vec3 a = surface.points[face[0]] - place, b = surface.points[face[1]] - place,
             c = surface.points[face[2]] - place;
  return a.dot(b.cross(c)) / 6;
}

/// Rounding error of the volume of a flat body, m^3.
inline double volume_rounding(double area, const Box& box) {
  return 1e-13 * area * box.diagonal().norm();
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Delaunay_triangulation_cell_base_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <sinew/core/parallel.h>
#include <sinew/core/particles.h>
#include <sinew/volume/detail/scaffold.h>

#include <algorithm>
#include <utility>

namespace sinew {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vertices = CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Kernel>;
using Data = CGAL::Triangulation_data_structure_3<Vertices,
                                                  CGAL::Delaunay_triangulation_cell_base_3<Kernel>>;
using Triangulation = CGAL::Delaunay_triangulation_3<Kernel, Data, CGAL::Fast_location>;

constexpr double longest = 4.5;         // radii: of edges between particles; what is longer bridges
constexpr double mirrored = 3;          // radii: depth of particles that have an image
constexpr std::size_t at_a_time = 256;  // points

/// Places in which no octahedron of a lattice is regular: in one that is, any four corners of a
/// square may become a cell without a volume, and so its shortest diagonal is an edge.
Kernel::Point_3 stretched(const Vec3& p) {
  constexpr double stretch = 1.05;
  static const Vec3 along = Vec3(0.31, 0.47, 0.83).normalized();
  const Vec3 q = p + (stretch - 1) * along.dot(p) * along;
  return {q.x(), q.y(), q.z()};
}

/// Images of particles behind the nearest point of the surface.
Points images_of(const Points& rest, double radius, const InsideSpace& space) {
  Points images(rest.size());
  std::vector<char> kept(rest.size());
  parallel_for(rest.size(), at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 foot = space.nearest(rest[i]).place, out = foot - rest[i];
      const double depth = out.norm();
      if (depth == 0 || depth > mirrored * radius) continue;
      images[i] = foot + out * std::max(1.0, radius / depth);
      kept[i] = !space.contains(images[i]);
    }
  });
  Points found;
  for (std::size_t i = 0; i < rest.size(); ++i)
    if (kept[i]) found.push_back(images[i]);
  return found;
}

}  // namespace

Scaffold delaunay(const Points& rest, double radius, const InsideSpace& space) {
  Scaffold scaffold;
  scaffold.points = rest;
  const Points images = images_of(rest, radius, space);
  scaffold.points.insert(scaffold.points.end(), images.begin(), images.end());
  std::vector<std::pair<Kernel::Point_3, std::uint32_t>> vertices;
  for (std::size_t i = 0; i < scaffold.points.size(); ++i) {
    const bool particle = i < rest.size();
    vertices.emplace_back(stretched(scaffold.points[i]), static_cast<std::uint32_t>(i));
    scaffold.inside.push_back(particle);
    scaffold.particle.push_back(particle ? static_cast<std::int32_t>(i) : -1);
  }
  const Triangulation all(vertices.begin(), vertices.end());
  for (auto cell = all.finite_cells_begin(); cell != all.finite_cells_end(); ++cell) {
    Cell corners;
    for (int v = 0; v < 4; ++v) corners[static_cast<std::size_t>(v)] = cell->vertex(v)->info();
    const auto is_inside = [&](std::uint32_t v) { return scaffold.inside[v] != 0; };
    if (std::none_of(corners.begin(), corners.end(), is_inside)) continue;
    bool bridges = false;
    for (const std::uint32_t a : corners)
      for (const std::uint32_t b : corners)
        bridges = bridges ||
                  (is_inside(a) && is_inside(b) && (rest[a] - rest[b]).norm() > longest * radius);
    if (!bridges) scaffold.cells.push_back(corners);
  }
  std::sort(scaffold.cells.begin(), scaffold.cells.end());
  return scaffold;
}

}  // namespace sinew

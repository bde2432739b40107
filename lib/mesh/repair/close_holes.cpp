// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>

#include <algorithm>
#include <iterator>

#include "mesh/repair/holes.h"
#include "mesh/repair/repair.h"

namespace sinew {
namespace {

using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
using Face = std::array<int, 3>;

constexpr std::size_t most_edges = 1000;       // CGAL's tables grow with the square
constexpr std::size_t most_edges_cubic = 100;  // all triangles instead of Delaunay's: the cube

struct Corners {
  int a, b, c;  ///< places in a hole
  Corners(int first, int second, int third) : a(first), b(second), c(third) {}
};

class Closer {
 public:
  explicit Closer(Triangles& surface) : surface_(surface) {}

  /// Faces that go along the hole's edges.
  void close(const Hole& hole) {
    if (hole.size() == 3) return add(hole, {0, 1, 2});
    const auto found = triangulated(hole);
    if (found.size() + 2 != hole.size()) return halve(hole);
    for (Corners corners : found) add(hole, corners);
  }

 private:
  /// In the order of the hole, whatever the order of the corners.
  void add(const Hole& hole, const Corners& corners) {
    std::array places = {corners.a, corners.b, corners.c};
    std::sort(places.begin(), places.end());
    surface_.faces.push_back({hole[places[0]].from, hole[places[1]].from, hole[places[2]].from});
  }

  Point point(int i) const {
    const Vec3& p = surface_.points[i];
    return {p.x(), p.y(), p.z()};
  }

  /// Nothing where CGAL finds nothing.
  std::vector<Corners> triangulated(const Hole& hole) const {
    std::vector<Corners> faces;
    if (hole.size() > most_edges) return faces;
    std::vector<Point> points, opposite;
    for (const HoleEdge& edge : hole) {
      points.push_back(point(edge.from));
      if (edge.opposite >= 0) opposite.push_back(point(edge.opposite));
    }
    if (opposite.size() < points.size()) opposite.clear();
    // Said to be optional, but where the first point equals the last CGAL takes that for it.
    points.push_back(points.front());
    if (!opposite.empty()) opposite.push_back(opposite.front());
    CGAL::Polygon_mesh_processing::triangulate_hole_polyline(
        points, opposite, std::back_inserter(faces),
        CGAL::parameters::use_delaunay_triangulation(true).do_not_use_cubic_algorithm(
            hole.size() > most_edges_cubic));
    return faces;
  }

  /// Along the shortest line between points half the hole apart.
  void halve(const Hole& hole) {
    const std::size_t half = hole.size() / 2;
    const auto length = [&](std::size_t i) {
      return (surface_.points[hole[i].from] - surface_.points[hole[i + half].from]).squaredNorm();
    };
    std::size_t cut = 0;
    for (std::size_t i = 1; i + half < hole.size(); ++i)
      if (length(i) < length(cut)) cut = i;
    const int from = hole[cut].from, to = hole[cut + half].from;
    Hole inner(hole.begin() + cut, hole.begin() + cut + half);
    Hole outer(hole.begin(), hole.begin() + cut);
    outer.push_back({from, to, -1});
    outer.insert(outer.end(), hole.begin() + cut + half, hole.end());
    inner.push_back({to, from, -1});
    close(inner);
    close(outer);
  }

  Triangles& surface_;
};

}  // namespace

HoleClosing close_holes(const Triangles& surface) {
  HoleClosing closing{surface};
  Closer closer(closing.triangles);
  for (const Hole& hole : holes_of(surface)) {
    closer.close(hole);
    ++closing.holes_closed;
  }
  closing.faces_added = closing.triangles.faces.size() - surface.faces.size();
  return closing;
}

}  // namespace sinew

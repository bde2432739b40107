// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/repair/repair.h>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>
#include <algorithm>
#include <cmath>
#include <iterator>

#include <sinew/core/error.h>
#include <sinew/core/text.h>
#include <sinew/mesh/border.h>
#include <sinew/mesh/solids.h>
#include <sinew/mesh/surface.h>
#include <sinew/repair/detail/holes.h>

namespace sinew {

namespace {

using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
using Face = std::array<int, 3>;

constexpr std::size_t max_edges = 1000;       // CGAL's tables grow with the square
constexpr std::size_t max_edges_cubic = 100;  // all triangles instead of Delaunay's: cubic time

struct Corners {
  int a, b, c;  ///< indices into a hole
  Corners(int first, int second, int third) : a(first), b(second), c(third) {}
};

class Closer {
 public:
  explicit Closer(Triangles& surface) : surface_(surface) {}

  /// Faces on the hole's edges.
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

  /// Nothing where CGAL finds no triangulation.
  std::vector<Corners> triangulated(const Hole& hole) const {
    std::vector<Corners> faces;
    if (hole.size() > max_edges) return faces;
    std::vector<Point> points, opposite;
    for (const HoleEdge& edge : hole) {
      points.push_back(point(edge.from));
      if (edge.opposite >= 0) opposite.push_back(point(edge.opposite));
    }
    if (opposite.size() < points.size()) opposite.clear();
    // Documented as optional, but where the first point equals the last CGAL takes it as given.
    points.push_back(points.front());
    if (!opposite.empty()) opposite.push_back(opposite.front());
    CGAL::Polygon_mesh_processing::triangulate_hole_polyline(
        points, opposite, std::back_inserter(faces),
        CGAL::parameters::use_delaunay_triangulation(true).do_not_use_cubic_algorithm(
            hole.size() > max_edges_cubic));
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

namespace {

using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;

constexpr double offset_fraction = 1.0 / 30;  // fraction of alpha: CGAL's default
constexpr double faces_per_square = 2.5;  // faces per square of edge alpha: measured, without leaks
constexpr double max_faces = 1e6;         // minutes
constexpr std::size_t max_points = 2'000'000;  // some GB, where it leaks into every corner

const char* const larger = "give a larger length or close the holes";

Error refusal(double alpha, const std::string& what, const std::string& cure) {
  std::string text = "a wrap at ";
  text.append(three_digits(alpha)).append(" m ").append(what);
  return bad_input(text, cure);
}

std::string millions(double count) { return three_digits(count / 1e6) + " million"; }

void refuse_alpha(const Triangles& surface, double alpha) {
  const double squares = area(surface), diagonal = bounds(surface.points).diagonal().norm();
  if (!(squares > 0)) throw refusal(alpha, "has no face with an area to lie on", "give a surface");
  if (!(alpha > 0 && alpha < diagonal)) {
    std::string what = "fits no mesh of a diagonal of ";
    what.append(three_digits(diagonal)).append(" m");
    throw refusal(alpha, what, "give a length between 0 and that");
  }
  const double most = faces_per_square * std::min(squares, diagonal * diagonal);
  const double faces = most / (alpha * alpha);
  if (faces <= max_faces) return;
  std::string what = "takes about ", cure = "give ";
  what.append(millions(faces)).append(" faces, more than ").append(millions(max_faces));
  cure.append(three_digits(1.01 * std::sqrt(most / max_faces))).append(" m or more");
  throw refusal(alpha, what, cure);
}

struct TooManyPoints {};

struct PointLimit : CGAL::Alpha_wraps_3::internal::Wrapping_default_visitor {
  std::size_t points = 0;

  template <class Wrapper, class Place>
  void before_Steiner_point_insertion(const Wrapper&, const Place&) {
    if (++points > max_points) throw TooManyPoints{};
  }
};

Triangles triangles_of(const Mesh& mesh, const Vec3& origin) {
  Triangles triangles;
  triangles.points.reserve(mesh.number_of_vertices());
  for (const auto vertex : mesh.vertices()) {
    const Point& p = mesh.point(vertex);
    triangles.points.push_back(origin + Vec3(p.x(), p.y(), p.z()));
  }
  triangles.faces.reserve(mesh.number_of_faces());
  for (const auto face : mesh.faces()) {
    auto corner = mesh.vertices_around_face(mesh.halfedge(face)).begin();
    std::array<int, 3>& corners = triangles.faces.emplace_back();
    for (int& index : corners) index = static_cast<int>((*corner++).idx());
  }
  return triangles;
}

Triangles wrapped(const Triangles& surface, double alpha) {
  const Vec3 middle = bounds(surface.points).center();  // far from 0 precision would be lost
  std::vector<Point> points;
  points.reserve(surface.points.size());
  for (const Vec3& point : surface.points) {
    const Vec3 p = point - middle;
    points.emplace_back(p.x(), p.y(), p.z());
  }
  Mesh mesh;
  PointLimit limit;
  CGAL::alpha_wrap_3(points, surface.faces, alpha, alpha * offset_fraction, mesh,
                     CGAL::parameters::default_values(),
                     CGAL::parameters::visitor(std::ref(limit)));
  return triangles_of(mesh, middle);
}

/// The volume that an open surface encloses once its holes are capped; 0 for a closed one.
double volume_behind_holes(const Triangles& surface) {
  const Triangles caps = caps_of(border_loops(edge_uses(surface)), surface.points);
  if (caps.faces.empty()) return 0;
  Triangles all = surface;
  append(caps, all);
  return std::abs(volume(all));
}

/// A wrap that has leaked is a film on both sides of the faces, with some filling in corners.
void refuse_leak(const Triangles& surface, const Triangles& skin, double alpha) {
  const double inside = volume(skin), film = area(skin) * alpha * offset_fraction;
  const double behind = volume_behind_holes(surface);
  std::string what = "encloses " + three_digits(inside);
  if (inside < behind / 2)
    what.append(" m^3 of ")
        .append(three_digits(behind))
        .append(" m^3: it leaks through a hole wider than that");
  else if (inside < 2 * film)
    what.append(
        " m^3 only, little more than the film it lays on the faces: they have no inside, or "
        "a hole wider than that");
  else
    return;
  throw refusal(alpha, what, larger);
}

}  // namespace

Triangles wrap(const Triangles& surface, double alpha) {
  refuse_alpha(surface, alpha);
  try {
    Triangles skin = wrapped(surface, alpha);
    refuse_leak(surface, skin, alpha);
    return skin;
  } catch (const TooManyPoints&) {
    std::string what = "takes more than ";
    what.append(millions(max_points)).append(" points, as one that leaks into a body does");
    throw refusal(alpha, what, larger);
  }
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/repair/capsules.h>

#include <sinew/repair/detail/addresses.h>
#undef CGAL_ALLOCATOR
#define CGAL_ALLOCATOR(T) sinew::Ascending<T>
#include <CGAL/Complex_2_in_triangulation_3.h>
#include <CGAL/IO/facets_in_complex_2_to_triangle_mesh.h>
#include <CGAL/Implicit_surface_3.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Random.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_default_triangulation_3.h>
#include <CGAL/make_surface_mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <sinew/mesh/clean.h>
#include <sinew/mesh/solids.h>
#include <sinew/mesh/winding.h>
#include <sinew/repair/repair.h>

namespace sinew {
namespace {

using Delaunay = CGAL::Surface_mesh_default_triangulation_3;
using Complex = CGAL::Complex_2_in_triangulation_3<Delaunay>;
using Kernel = Delaunay::Geom_traits;
using Place = Kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Place>;

constexpr double min_angle = 25;    // degrees, of a face
constexpr double error = 1.0 / 12;  // of a side, from the surface to the middle of a face
constexpr double bisection = 1e-5;  // of the sphere around all
constexpr unsigned seed = 1;

double distance_to(const Capsule& capsule, const Vec3& point) {
  const Vec3 along = capsule.to - capsule.from, offset = point - capsule.from;
  const double square = along.squaredNorm();
  const double s = square > 0 ? std::clamp(offset.dot(along) / square, 0.0, 1.0) : 0;
  return (offset - s * along).norm() - capsule.radius;
}

/// Negative inside, m.
class Distance {
 public:
  using Point = Place;
  using FT = Kernel::FT;

  explicit Distance(const std::vector<Capsule>& capsules) : capsules_(&capsules) {}

  FT operator()(const Place& place) const {
    const Vec3 point(place.x(), place.y(), place.z());
    double least = std::numeric_limits<double>::infinity();
    for (const Capsule& capsule : *capsules_) least = std::min(least, distance_to(capsule, point));
    return least;
  }

 private:
  const std::vector<Capsule>* capsules_;
};

/// A sphere around all, whose middle is inside.
Kernel::Sphere_3 sphere_around(const std::vector<Capsule>& capsules) {
  const Capsule& thickest =
      *std::max_element(capsules.begin(), capsules.end(),
                        [](const Capsule& a, const Capsule& b) { return a.radius < b.radius; });
  const Vec3 middle = (thickest.from + thickest.to) / 2;
  double reach = 0;
  for (const Capsule& one : capsules)
    for (const Vec3& end : {one.from, one.to})
      reach = std::max(reach, (end - middle).norm() + one.radius);
  return {Place(middle.x(), middle.y(), middle.z()), 1.21 * reach * reach};
}

/// Empty where there is nothing to mesh.
Triangles meshed(const std::vector<Capsule>& capsules, double side) {
  if (capsules.empty()) return {};
  const Addresses ascending;
  CGAL::get_default_random() = CGAL::Random(seed);  // the mesher's first rays
  Delaunay delaunay;
  Complex complex(delaunay);
  const CGAL::Implicit_surface_3<Kernel, Distance> surface(Distance(capsules),
                                                           sphere_around(capsules), bisection);
  const CGAL::Surface_mesh_default_criteria_3<Delaunay> criteria(min_angle, side, error * side);
  CGAL::make_surface_mesh(complex, surface, criteria, CGAL::Manifold_tag());
  Mesh mesh;
  CGAL::facets_in_complex_2_to_triangle_mesh(complex, mesh);
  if (!CGAL::is_closed(mesh) || mesh.number_of_faces() == 0) return {};
  if (!CGAL::Polygon_mesh_processing::is_outward_oriented(mesh))
    CGAL::Polygon_mesh_processing::reverse_face_orientations(mesh);
  Triangles skin;
  for (const auto& vertex : mesh.vertices()) {
    const Place& place = mesh.point(vertex);
    skin.points.emplace_back(place.x(), place.y(), place.z());
  }
  for (const auto& face : mesh.faces()) {
    std::array<int, 3> corners{};
    std::size_t k = 0;
    for (const auto& vertex : mesh.vertices_around_face(mesh.halfedge(face)))
      corners[k++] = static_cast<int>(static_cast<std::uint32_t>(vertex));
    skin.faces.push_back(corners);
  }
  return skin;
}

/// Whether a skin is around all parts.
bool holds(const Triangles& skin, const std::vector<Capsule>& capsules) {
  if (skin.faces.empty()) return false;
  PolygonSoup soup{skin.points, {}};
  for (const auto& face : skin.faces) soup.polygons.emplace_back(face.begin(), face.end());
  const Winding winding = winding_of(clean(soup));
  return std::all_of(capsules.begin(), capsules.end(), [&](const Capsule& one) {
    const auto is_inside = [&](double s) {
      return winding.around(one.from + s * (one.to - one.from)).value_or(0) > 0;
    };
    return is_inside(0) && is_inside(0.5) && is_inside(1);
  });
}

}  // namespace

Triangles skin_around(const std::vector<Capsule>& capsules, double side) {
  Triangles skin = meshed(capsules, side);
  if (holds(skin, capsules)) return skin;
  Triangles all;
  for (const Capsule& one : capsules) append(capsule_between(one.from, one.to, one.radius), all);
  return wrap(all, side);
}

}  // namespace sinew

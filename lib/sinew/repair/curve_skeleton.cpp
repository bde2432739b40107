// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/repair/curve_skeleton.h>

#include <CGAL/Polygon_mesh_processing/bbox.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Random.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <sinew/core/error.h>
#include <sinew/mesh/face_queries.h>
#include <sinew/mesh/surface.h>
#include <sinew/repair/detail/addresses.h>
#include <sinew/repair/repair.h>

#undef CGAL_ALLOCATOR
#define CGAL_ALLOCATOR(T) sinew::Ascending<T>
#include <CGAL/Polyhedron_3.h>
#undef CGAL_ALLOCATOR
#define CGAL_ALLOCATOR(T) std::allocator<T>
#include <CGAL/Mean_curvature_flow_skeletonization.h>

namespace sinew {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Point = CGAL::Simple_cartesian<double>::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;
using Flow = CGAL::Mean_curvature_flow_skeletonization<Mesh>;

constexpr double wanted_faces = 6000;   // half a second of contraction
constexpr double min_faces = 800;       // least number for each part
constexpr double small_part = 0.01;     // fraction of the largest part's volume
constexpr double wrapped_faces = 6000;  // faces of CGAL's wrap, 2.5 to a square of its length
constexpr int rounds = 3;               // passes of remeshing: more change little
constexpr std::size_t max_contractions = 500;
constexpr std::ptrdiff_t max_handles = 40;  // sponges take minutes to contract
constexpr std::size_t max_parts = 40;       // each takes a tenth of a second

Vec3 vector_of(const Point& p) { return {p.x(), p.y(), p.z()}; }

/// Contraction depends on sizes through tolerances: a body is contracted about 0, with diagonal 1.
struct Frame {
  Vec3 middle = Vec3::Zero();
  double size = 1;

  Point to(const Vec3& p) const {
    const Vec3 q = (p - middle) / size;
    return {q.x(), q.y(), q.z()};
  }
  Vec3 from(const Point& p) const { return middle + size * vector_of(p); }
};

/// Nothing where the faces are not those of a closed surface.
Mesh closed_mesh(const Triangles& surface, const Frame& frame) {
  Mesh mesh;
  std::vector<Point> points;
  points.reserve(surface.points.size());
  for (const Vec3& p : surface.points) points.push_back(frame.to(p));
  std::vector<std::array<int, 3>> faces;
  for (const auto& face : surface.faces)
    if (face_area(surface, face) > 0) faces.push_back(face);
  if (!pmp::is_polygon_soup_a_polygon_mesh(faces)) return mesh;
  pmp::polygon_soup_to_polygon_mesh(points, faces, mesh);
  if (!CGAL::is_closed(mesh)) mesh.clear();
  return mesh;
}

/// In some thousand faces for all parts together, and some hundred for each.
void make_even(Mesh& mesh, double area_of_all) {
  const double own = pmp::area(mesh);
  const double faces = std::max(wanted_faces * own / area_of_all, min_faces);
  const double edge = std::sqrt(own / faces / 0.433);
  pmp::isotropic_remeshing(mesh.faces(), edge, mesh, pmp::parameters::number_of_iterations(rounds));
  mesh.collect_garbage();
}

/// A sponge has no limbs, and takes minutes to contract.
void refuse_sponge(const Mesh& part) {
  const auto count = [](std::size_t n) { return static_cast<std::ptrdiff_t>(n); };
  const std::ptrdiff_t euler = count(part.number_of_vertices()) - count(part.number_of_edges()) +
                               count(part.number_of_faces());
  if (1 - euler / 2 > max_handles)
    throw bad_input("the surface has " + std::to_string(1 - euler / 2) + " handles",
                    "give the bones of a rig");
}

/// Adds the curves of one part.
void contract(const Mesh& part, const Frame& frame, CurveGraph& graph) {
  const Addresses ascending;
  Flow flow(part);
  flow.set_max_iterations(max_contractions);
  Flow::Skeleton curves;
  flow(curves);
  const int first = static_cast<int>(graph.points.size());
  for (const auto vertex : CGAL::make_range(boost::vertices(curves))) {
    const int number = static_cast<int>(graph.points.size());
    graph.points.push_back(frame.from(curves[vertex].point));
    for (const auto of_skin : curves[vertex].vertices) {
      graph.skin.push_back(frame.from(part.point(of_skin)));
      graph.owner.push_back(number);
    }
  }
  for (const auto edge : CGAL::make_range(boost::edges(curves)))
    graph.links.push_back({first + static_cast<int>(boost::source(edge, curves)),
                           first + static_cast<int>(boost::target(edge, curves))});
}

/// The parts worth bones, the largest first.
std::vector<Mesh> parts_of(const Mesh& mesh) {
  std::vector<Mesh> parts;
  pmp::split_connected_components(mesh, parts);
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < parts.size(); ++i)
    order.emplace_back(-std::abs(pmp::volume(parts[i])), i);
  std::sort(order.begin(), order.end());
  std::vector<Mesh> large;
  for (const auto& [volume, i] : order)
    if (volume <= small_part * order.front().first && large.size() < max_parts)
      large.push_back(parts[i]);
  return large;
}

/// Whether some of them may be one body together, or a cavity of another.
bool any_overlap(const std::vector<Mesh>& parts) {
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (CGAL::do_overlap(pmp::bbox(parts[i]), pmp::bbox(parts[j]))) return true;
  return false;
}

CurveGraph contracted(std::vector<Mesh> parts, const Frame& frame) {
  CGAL::get_default_random() = CGAL::Random(0);  // whatever was computed before
  CurveGraph graph;
  double area_of_all = 0;
  for (const Mesh& part : parts) area_of_all += pmp::area(part);
  for (Mesh& part : parts) {
    refuse_sponge(part);
    make_even(part, area_of_all);
    contract(part, frame, graph);
  }
  return graph;
}

/// A closed skin of some thousand faces around any surface.
Triangles wrapped_skin(const Triangles& surface) {
  const Triangles closed = close_holes(surface).triangles;
  return wrap(closed, std::sqrt(2.5 * area(closed) / wrapped_faces));
}

void measure_inner(const Triangles& surface, CurveGraph& graph) {
  const NearestFace nearest(surface);
  graph.inner.reserve(graph.points.size());
  for (const Vec3& point : graph.points)
    graph.inner.push_back((nearest.to(point).place - point).norm());
}

/// A spike of almost no area would be cut into pieces without end.
void refuse_needle(const Triangles& surface) {
  constexpr double max_pieces = 1e4;  // pieces per edge, in the mean over as many faces as wanted
  double area = 0, lengths = 0;
  for (const auto& face : surface.faces) {
    area += face_area(surface, face);
    for (int k = 0; k < 3; ++k)
      lengths += (surface.points[face[k]] - surface.points[face[(k + 1) % 3]]).norm() / 2;
  }
  if (!(lengths < max_pieces * wanted_faces * std::sqrt(area / wanted_faces)))
    throw bad_input("the surface is too long for its area: no limbs can be found in it",
                    "repair it, or give the bones of a rig");
}

}  // namespace

CurveGraph curve_skeleton(const Triangles& surface) {
  refuse_needle(surface);
  const Box box = bounds(surface.points);
  const Frame frame{box.center(), box.diagonal().norm()};
  CurveGraph graph;
  try {
    std::vector<Mesh> parts = parts_of(closed_mesh(surface, frame));
    if (!any_overlap(parts)) graph = contracted(std::move(parts), frame);
  } catch (const std::exception&) {  // CGAL's checks, of surfaces that cut themselves
    graph = {};
  }
  if (!graph.points.empty()) {
    measure_inner(surface, graph);
    return graph;
  }
  const Triangles skin = wrapped_skin(surface);
  graph = contracted(parts_of(closed_mesh(skin, frame)), frame);
  if (graph.points.empty())
    throw bad_input("the surface contracts to no curve", "give the bones of a rig");
  measure_inner(skin, graph);
  return graph;
}

}  // namespace sinew

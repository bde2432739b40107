// SPDX-License-Identifier: GPL-3.0-or-later
#include "fill/side_of.h"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>

#include <vector>

namespace sinew {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;
using AabbTree =
    CGAL::AABB_tree<CGAL::AABB_traits<Kernel, CGAL::AABB_face_graph_triangle_primitive<Mesh>>>;

Point point_of(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

}  // namespace

struct SideOf::Tree {
  explicit Tree(const Triangles& surface) {
    for (const auto& [a, b, c] : surface.faces)
      add(point_of(surface.points[a]), point_of(surface.points[b]), point_of(surface.points[c]));
    tree.insert(faces(mesh).begin(), faces(mesh).end(), mesh);
    tree.build();  // before many threads use it
    side = std::make_unique<CGAL::Side_of_triangle_mesh<Mesh, Kernel>>(tree);
  }

  /// Each face with corners of its own: crossings need no connections, and none can fail.
  void add(const Point& a, const Point& b, const Point& c) {
    if (CGAL::collinear(a, b, c)) return;
    mesh.add_face(mesh.add_vertex(a), mesh.add_vertex(b), mesh.add_vertex(c));
  }

  Mesh mesh;
  AabbTree tree;
  std::unique_ptr<CGAL::Side_of_triangle_mesh<Mesh, Kernel>> side;
};

SideOf::SideOf(const Triangles& surface) : tree_(std::make_unique<Tree>(surface)) {}
SideOf::~SideOf() = default;

Side SideOf::side(const Vec3& point) const {
  switch ((*tree_->side)(point_of(point))) {
    case CGAL::ON_BOUNDED_SIDE:
      return Side::inside;
    case CGAL::ON_BOUNDARY:
      return Side::boundary;
    default:
      return Side::outside;
  }
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/fill/detail/verify.h>

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <algorithm>
#include <vector>

#include <sinew/core/error.h>
#include <sinew/core/parallel.h>

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

  /// Each face has its own corners: crossings need no connectivity, and building cannot fail.
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

namespace {

constexpr std::size_t rows_at_a_time = 16;

/// One row against the runs from `next` on, which are moved past it.
Verification verify_row(const Lattice& lattice, std::size_t row, const SideOf& cgal,
                        std::vector<Run>::const_iterator& next,
                        std::vector<Run>::const_iterator end) {
  Verification found;
  for (int n = 0; n < lattice.rows[row].sites; ++n) {
    while (next != end && next->row == static_cast<std::int32_t>(row) && next->last <= n) ++next;
    const bool inside =
        next != end && next->row == static_cast<std::int32_t>(row) && next->first <= n;
    const Side side = cgal.side(lattice.site(lattice.rows[row], n));
    ++found.sites;
    found.on_surface += side == Side::boundary;
    found.mismatches += inside != (side == Side::inside);
  }
  return found;
}

void add(Verification& sum, const Verification& part) {
  sum.sites += part.sites;
  sum.on_surface += part.on_surface;
  sum.mismatches += part.mismatches;
}

}  // namespace

void refuse_unverifiable(const Surface& surface) {
  if (surface.closed()) return;
  throw bad_input("only closed surfaces can be verified, and this one has " +
                      std::to_string(surface.border.edges) + " open edges",
                  "close its holes, or leave the verification out");
}

Verification verify(const Lattice& lattice, const Surface& surface, const InsideRuns& inside) {
  refuse_unverifiable(surface);
  const SideOf cgal(surface.triangles);
  const std::size_t rows = lattice.rows.size();
  std::vector<Verification> pieces((rows + rows_at_a_time - 1) / rows_at_a_time);
  parallel_for(rows, rows_at_a_time, [&](std::size_t begin, std::size_t end) {
    const auto before = [](const Run& run, std::size_t row) {
      return run.row < static_cast<std::int32_t>(row);
    };
    auto next = std::lower_bound(inside.runs.begin(), inside.runs.end(), begin, before);
    for (std::size_t row = begin; row < end; ++row) {
      while (next != inside.runs.end() && before(*next, row)) ++next;
      add(pieces[begin / rows_at_a_time], verify_row(lattice, row, cgal, next, inside.runs.end()));
    }
  });
  Verification sum;
  for (const Verification& piece : pieces) add(sum, piece);
  return sum;
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
#include "fill/self_intersections.h"

#include <CGAL/Box_intersection_d/Box_with_info_d.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Intersections_3/Segment_3_Triangle_3.h>
#include <CGAL/Intersections_3/Triangle_3_Triangle_3.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <vector>

namespace sinew {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using FaceBox = CGAL::Box_intersection_d::Box_with_info_d<double, 3, int>;
using Face = std::array<int, 3>;

/// Brings corners that both faces have to the front, in the same order; returns how many.
int align(Face& a, Face& b) {
  int shared = 0;
  for (int i = 0; i < 3; ++i) {
    auto* found = std::find(b.begin() + shared, b.end(), a[i]);
    if (found == b.end()) continue;
    std::swap(*found, b[shared]);
    std::swap(a[i], a[shared]);
    ++shared;
  }
  return shared;
}

class PairTest {
 public:
  explicit PairTest(const Points& points) : points_(points) {}

  bool meet(Face a, Face b) const {
    const int shared = align(a, b);
    if (shared == 0) return CGAL::do_intersect(triangle(a), triangle(b));
    if (shared == 1)  // beyond the corner they share, one's far side must cross the other
      return CGAL::do_intersect(triangle(a), Kernel::Segment_3(point(b[1]), point(b[2]))) ||
             CGAL::do_intersect(triangle(b), Kernel::Segment_3(point(a[1]), point(a[2])));
    return folded(a, b);
  }

  bool flat(const Face& face) const {
    return CGAL::collinear(point(face[0]), point(face[1]), point(face[2]));
  }

  CGAL::Bbox_3 box(const Face& face) const { return triangle(face).bbox(); }

 private:
  /// Two faces at one edge overlap only when one is folded flat onto the other.
  bool folded(const Face& a, const Face& b) const {
    const Point p = point(a[0]), q = point(a[1]), r = point(a[2]), s = point(b[2]);
    return CGAL::coplanar(p, q, r, s) && CGAL::coplanar_orientation(p, q, r, s) == CGAL::POSITIVE;
  }

  Point point(int i) const { return {points_[i].x(), points_[i].y(), points_[i].z()}; }
  Kernel::Triangle_3 triangle(const Face& f) const {
    return {point(f[0]), point(f[1]), point(f[2])};
  }

  const Points& points_;
};

struct Enough {};

}  // namespace

SelfIntersections self_intersections(const Triangles& surface, std::size_t most) {
  const PairTest test(surface.points);
  std::vector<FaceBox> boxes;
  for (std::size_t i = 0; i < surface.faces.size(); ++i)
    if (!test.flat(surface.faces[i]))
      boxes.emplace_back(test.box(surface.faces[i]), static_cast<int>(i));

  SelfIntersections found;
  found.flat = surface.faces.size() - boxes.size();
  const auto visit = [&](const FaceBox& a, const FaceBox& b) {
    const std::array<int, 2> pair = {std::min(a.info(), b.info()), std::max(a.info(), b.info())};
    if (!test.meet(surface.faces[pair[0]], surface.faces[pair[1]])) return;
    found.first = found.pairs == 0 ? pair : std::min(found.first, pair);
    if (++found.pairs == most) throw Enough{};
  };
  try {
    CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), visit);
  } catch (const Enough&) {
    found.complete = false;
  }
  return found;
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/self_intersections.h"

#include <CGAL/Box_intersection_d/Box_with_info_d.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Intersections_3/Segment_3_Triangle_3.h>
#include <CGAL/Intersections_3/Triangle_3_Triangle_3.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <map>
#include <tuple>
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

/// What is tested: a face, or a part of one.
struct Part {
  Face corners;
  int face;
};

using Middles = std::map<std::array<int, 2>, int>;

/// The longest sides of the faces without area, each with the point between its ends.
Middles middles_of(const Triangles& surface, const PairTest& test) {
  Middles middles;
  for (Face face : surface.faces) {
    if (!test.flat(face)) continue;
    std::sort(face.begin(), face.end(), [&](int a, int b) {  // along the line they lie on
      const Vec3 &p = surface.points[a], &q = surface.points[b];
      return std::tie(p.x(), p.y(), p.z()) < std::tie(q.x(), q.y(), q.z());
    });
    middles[{std::min(face[0], face[2]), std::max(face[0], face[2])}] = face[1];
  }
  return middles;
}

/// Cuts a face until none of its sides has a point in its middle.
void add_parts(const Part& part, const Middles& middles, std::vector<Part>& parts) {
  for (int i = 0; i < 3; ++i) {
    const int from = part.corners[i], to = part.corners[(i + 1) % 3],
              top = part.corners[(i + 2) % 3];
    const auto middle = middles.find({std::min(from, to), std::max(from, to)});
    if (middle == middles.end() || middle->second == top) continue;
    add_parts({{from, middle->second, top}, part.face}, middles, parts);
    add_parts({{middle->second, to, top}, part.face}, middles, parts);
    return;
  }
  parts.push_back(part);
}

std::vector<Part> parts_of(const Triangles& surface, const PairTest& test) {
  const Middles middles = middles_of(surface, test);
  std::vector<Part> parts;
  for (std::size_t i = 0; i < surface.faces.size(); ++i)
    if (!test.flat(surface.faces[i]))
      add_parts({surface.faces[i], static_cast<int>(i)}, middles, parts);
  return parts;
}

struct Enough {};

}  // namespace

SelfIntersections self_intersections(const Triangles& surface, std::size_t most) {
  const PairTest test(surface.points);
  const std::vector<Part> parts = parts_of(surface, test);
  std::vector<FaceBox> boxes;
  for (std::size_t i = 0; i < parts.size(); ++i)
    boxes.emplace_back(test.box(parts[i].corners), static_cast<int>(i));

  SelfIntersections found;
  const auto visit = [&](const FaceBox& a, const FaceBox& b) {
    const auto [p, q] = std::minmax({a.info(), b.info()});
    if (parts[p].face == parts[q].face || !test.meet(parts[p].corners, parts[q].corners)) return;
    const std::array<int, 2> pair = {parts[p].face, parts[q].face};
    found.first = found.pairs == 0 ? pair : std::min(found.first, pair);
    if (++found.pairs == most) throw Enough{};
  };
  try {
    CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), visit);
  } catch (const Enough&) {
    found.complete = false;
  }
  for (const Face& face : surface.faces) found.flat += test.flat(face);
  return found;
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/repair/self_intersections.h>

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

constexpr std::size_t min_tests = 2'000'000, tests_per_face = 20;  // 5 to 12 are usual

/// Moves the corners that both faces share to the front, in the same order; returns their number.
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
    if (shared == 1)  // beyond the shared corner, the far side of one must cross the other
      return !aside(a, b) && !aside(b, a) &&
             (CGAL::do_intersect(triangle(a), Kernel::Segment_3(point(b[1]), point(b[2]))) ||
              CGAL::do_intersect(triangle(b), Kernel::Segment_3(point(a[1]), point(a[2]))));
    return folded(a, b);
  }

  bool flat(const Face& face) const {
    return CGAL::collinear(point(face[0]), point(face[1]), point(face[2]));
  }

  CGAL::Bbox_3 box(const Face& face) const { return triangle(face).bbox(); }

 private:
  /// Whether all of b but the shared corner is on one side of a's plane: the usual case.
  bool aside(const Face& a, const Face& b) const {
    const Point p = point(a[0]), q = point(a[1]), r = point(a[2]);
    const auto side = CGAL::orientation(p, q, r, point(b[1]));
    return side != CGAL::COPLANAR && side == CGAL::orientation(p, q, r, point(b[2]));
  }

  /// Two faces at one edge overlap only where one is folded flat onto the other.
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

/// A tested face, or a part of one.
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
    const auto before = [&](int a, int b) {  // along the line they lie on
      const Vec3 &p = surface.points[a], &q = surface.points[b];
      return std::tie(p.x(), p.y(), p.z()) < std::tie(q.x(), q.y(), q.z());
    };
    std::sort(face.begin(), face.end(), before);
    // Points of one place are not between others: two such faces would cut each other without end.
    if (!before(face[0], face[1]) || !before(face[1], face[2])) continue;
    middles[{std::min(face[0], face[2]), std::max(face[0], face[2])}] = face[1];
  }
  return middles;
}

/// Cuts a face until none of its sides has a point between its ends.
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

std::size_t max_tests(const Triangles& surface) {
  return std::max(min_tests, tests_per_face * surface.faces.size());
}

struct Enough {};

/// Receives pairs of boxes and keeps those whose parts intersect.
class Search {
 public:
  Search(const Triangles& surface, const PairTest& test, std::size_t most)
      : test_(test),
        parts_(parts_of(surface, test)),
        max_pairs_(most),
        max_tests_(max_tests(surface)) {
    found_.faces.resize(surface.faces.size());
  }

  SelfIntersections run() {
    std::vector<FaceBox> boxes;
    for (std::size_t i = 0; i < parts_.size(); ++i)
      boxes.emplace_back(test_.box(parts_[i].corners), static_cast<int>(i));
    try {
      CGAL::box_self_intersection_d(
          boxes.begin(), boxes.end(),
          [this](const FaceBox& a, const FaceBox& b) { take(a.info(), b.info()); });
    } catch (const Enough&) {
      found_.complete = false;
    }
    return std::move(found_);
  }

 private:
  void take(int a, int b) {
    if (++tests_ > max_tests_) throw Enough{};
    const auto [p, q] = std::minmax(a, b);
    const std::array<int, 2> pair = {parts_[p].face, parts_[q].face};
    if (pair[0] == pair[1] || !test_.meet(parts_[p].corners, parts_[q].corners)) return;
    found_.first = found_.pairs == 0 ? pair : std::min(found_.first, pair);
    for (const int face : pair) found_.faces[face] = true;
    if (++found_.pairs == max_pairs_) throw Enough{};
  }

  const PairTest& test_;
  std::vector<Part> parts_;
  std::size_t max_pairs_, max_tests_, tests_ = 0;
  SelfIntersections found_;
};

}  // namespace

SelfIntersections self_intersections(const Triangles& surface, std::size_t most) {
  const PairTest test(surface.points);
  return Search(surface, test, most).run();
}

SelfIntersections self_intersections(const FaceTree& tree) {
  const Triangles& surface = tree.surface();
  const PairTest test(surface.points);
  const auto flat = [&](const Face& face) { return test.flat(face); };
  const std::size_t tests = max_tests(surface);
  const auto pairs = tree.meeting_boxes(tests);
  // Where faces are cut, or not all pairs are tested, these depend on the order of the search.
  if (pairs.size() > tests || tree.faces().size() < surface.faces.size() ||
      std::any_of(surface.faces.begin(), surface.faces.end(), flat))
    return self_intersections(surface);
  SelfIntersections found;
  found.faces.resize(surface.faces.size());
  for (auto [a, b] : pairs) {
    if (b < a) std::swap(a, b);
    if (!test.meet(surface.faces[a], surface.faces[b])) continue;
    const std::array<int, 2> pair = {static_cast<int>(a), static_cast<int>(b)};
    found.first = found.pairs == 0 ? pair : std::min(found.first, pair);
    found.faces[a] = found.faces[b] = true;
    if (++found.pairs == max_pairs) return self_intersections(surface);
  }
  return found;
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/mesh/face_tree.h>

#include <CGAL/Simple_cartesian.h>
#include <algorithm>
#include <cmath>
#include <limits>

#include <sinew/mesh/surface.h>

namespace sinew {

namespace {

using Kernel = CGAL::Simple_cartesian<double>;

Kernel::Point_3 point_of(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

constexpr double relative_rounding = 1e-13;  // rounding of distances over the size of coordinates

/// The longest axis, as CGAL's tree picks one of equal ones.
int longest_axis(const Box& box) {
  const Vec3 size = box.max() - box.min();
  if (size.x() >= size.y()) return size.x() >= size.z() ? 0 : 2;
  return size.y() >= size.z() ? 1 : 2;
}

/// Squared distance of a point from a triangle (Ericson 2005, Real-Time Collision
/// Detection, 5.1.5).
double squared_distance_to(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& point) {
  const Vec3 ab = b - a, ac = c - a, ap = point - a, bp = point - b, cp = point - c;
  const double ab_a = ab.dot(ap), ac_a = ac.dot(ap);
  if (ab_a <= 0 && ac_a <= 0) return ap.squaredNorm();
  const double ab_b = ab.dot(bp), ac_b = ac.dot(bp);
  if (ab_b >= 0 && ac_b <= ab_b) return bp.squaredNorm();
  const double ab_c = ab.dot(cp), ac_c = ac.dot(cp);
  if (ac_c >= 0 && ab_c <= ac_c) return cp.squaredNorm();
  const double w = ab_a * ac_b - ab_b * ac_a;
  if (w <= 0 && ab_a >= 0 && ab_b <= 0) return (ap - ab_a / (ab_a - ab_b) * ab).squaredNorm();
  const double v = ab_c * ac_a - ab_a * ac_c;
  if (v <= 0 && ac_a >= 0 && ac_c <= 0) return (ap - ac_a / (ac_a - ac_c) * ac).squaredNorm();
  const double u = ab_b * ac_c - ab_c * ac_b, to_c = ac_b - ab_b, to_b = ab_c - ac_c;
  if (u <= 0 && to_c >= 0 && to_b >= 0) return (bp - to_c / (to_c + to_b) * (c - b)).squaredNorm();
  return (ap - (v * ab + w * ac) / (u + v + w)).squaredNorm();
}

}  // namespace

/// A face while the order is found.
struct FaceTree::Unsorted {
  Vec3 first;  ///< corner
  std::uint32_t face;
};

FaceTree::FaceTree(Triangles surface) : surface_(std::move(surface)) {
  std::vector<Unsorted> faces;
  faces.reserve(surface_.faces.size());
  std::vector<Box> boxes(surface_.faces.size());
  Box all;
  for (std::size_t f = 0; f < boxes.size(); ++f) {
    if (!(face_area(surface_, surface_.faces[f]) > 0)) continue;
    for (const int corner : surface_.faces[f]) boxes[f].extend(surface_.points[corner]);
    all.extend(boxes[f]);
    faces.push_back({surface_.points[surface_.faces[f][0]], static_cast<std::uint32_t>(f)});
  }
  if (faces.empty()) return;
  rounding_ = relative_rounding * all.min().cwiseAbs().cwiseMax(all.max().cwiseAbs()).norm();
  nodes_.resize(faces.size());
  expand({0, 0, faces.size()}, faces, boxes);
  order_.reserve(faces.size()), sorted_.reserve(faces.size()), boxes_.reserve(faces.size());
  for (const Unsorted& one : faces) {
    const auto& [a, b, c] = surface_.faces[one.face];
    order_.push_back(one.face);
    sorted_.push_back({surface_.points[a], surface_.points[b], surface_.points[c]});
    boxes_.push_back(boxes[one.face]);
  }
}

void FaceTree::expand(const Part& part, std::vector<Unsorted>& faces,
                      const std::vector<Box>& boxes) {
  if (part.count < 2) return;
  const auto begin = faces.begin() + static_cast<std::ptrdiff_t>(part.first);
  const auto end = begin + static_cast<std::ptrdiff_t>(part.count);
  Box box;
  for (auto one = begin; one != end; ++one) box.extend(boxes[one->face]);
  nodes_[part.node] = box;
  const int axis = longest_axis(box);
  std::nth_element(begin, begin + static_cast<std::ptrdiff_t>(part.count / 2), end,
                   [axis](const Unsorted& one, const Unsorted& other) {
                     return one.first[axis] < other.first[axis];
                   });
  expand(part.left(), faces, boxes);
  expand(part.right(), faces, boxes);
}

double FaceTree::squared_distance(const Part& part, const Box& box) const {
  const Box& own = box_of(part);
  const Vec3 apart = (own.min() - box.max()).cwiseMax(box.min() - own.max()).cwiseMax(0);
  return apart.squaredNorm();
}

void FaceTree::approach(const Part& part, const Box& point, double& squared) const {
  if (part.count == 1) {
    const Face& face = sorted_[part.first];
    squared = std::min(squared, squared_distance_to(face.a, face.b, face.c, point.min()));
    return;
  }
  const double left = squared_distance(part.left(), point);
  const double right = squared_distance(part.right(), point);
  const bool left_first = left <= right;
  if (left_first && left < squared) approach(part.left(), point, squared);
  if (right < squared) approach(part.right(), point, squared);
  if (!left_first && left < squared) approach(part.left(), point, squared);
}

double FaceTree::distance(const Vec3& point, double bound) const {
  double squared = bound * bound;
  approach(whole(), Box(point), squared);
  return std::sqrt(squared);
}

void FaceTree::find_near(const Box& box, double reach, Candidates& found) const {
  found.face.clear();
  reach += rounding_;
  find_near(whole(), box, reach * reach, found.face);
}

void FaceTree::find_near(const Part& part, const Box& box, double squared_reach,
                         std::vector<std::uint32_t>& found) const {
  if (squared_distance(part, box) > squared_reach) return;
  if (part.count == 1) {
    found.push_back(static_cast<std::uint32_t>(part.first));
    return;
  }
  find_near(part.left(), box, squared_reach, found);
  find_near(part.right(), box, squared_reach, found);
}

/// Collects pairs of faces whose boxes meet.
struct FaceTree::Pairs {
  const FaceTree& tree;
  std::size_t most;
  std::vector<std::array<std::uint32_t, 2>> found = {};

  void within(const Part& part) {
    if (part.count == 1 || found.size() > most) return;
    within(part.left());
    within(part.right());
    between(part.left(), part.right());
  }

  void between(const Part& one, const Part& other) {
    if (found.size() > most || !meet(tree.box_of(one), tree.box_of(other))) return;
    if (one.count == 1 && other.count == 1) {
      found.push_back({tree.order_[one.first], tree.order_[other.first]});
    } else if (one.count >= other.count) {
      between(one.left(), other);
      between(one.right(), other);
    } else {
      between(one, other.left());
      between(one, other.right());
    }
  }

  static bool meet(const Box& a, const Box& b) {
    return (a.min().array() <= b.max().array()).all() && (b.min().array() <= a.max().array()).all();
  }
};

std::vector<std::array<std::uint32_t, 2>> FaceTree::meeting_boxes(std::size_t most) const {
  Pairs pairs{*this, most};
  if (!order_.empty()) pairs.within(whole());
  return std::move(pairs.found);
}

Vec3 FaceTree::nearest(const Vec3& point, double bound, Candidates& candidates) const {
  const auto squared_with_rounding = [&](double distance) {
    return (distance + rounding_) * (distance + rounding_);
  };
  constexpr double infinite = std::numeric_limits<double>::infinity();
  std::vector<double>& squared = candidates.squared;
  squared.assign(candidates.face.size(), infinite);
  double limit = squared_with_rounding(bound);
  for (std::size_t k = 0; k < squared.size(); ++k) {
    const Box& box = boxes_[candidates.face[k]];
    if ((box.min() - point).cwiseMax(point - box.max()).cwiseMax(0).squaredNorm() > limit) continue;
    const Face& face = sorted_[candidates.face[k]];
    squared[k] = squared_distance_to(face.a, face.b, face.c, point);
    if (squared[k] < limit) limit = std::min(limit, squared_with_rounding(std::sqrt(squared[k])));
  }
  // CGAL's search begins with first corners, and of equally near projections ends with the last.
  const Kernel::Point_3 from = point_of(point);
  double corner = infinite, projection = infinite;
  Vec3 at_corner, projected;
  for (std::size_t k = 0; k < squared.size(); ++k) {
    if (squared[k] > limit) continue;
    const Face& face = sorted_[candidates.face[k]];
    const Kernel::Triangle_3 triangle(point_of(face.a), point_of(face.b), point_of(face.c));
    if (const double to = CGAL::squared_distance(from, triangle[0]); to < corner)
      corner = to, at_corner = face.a;
    const Kernel::Point_3 place = Kernel().construct_projected_point_3_object()(triangle, from);
    if (const double to = CGAL::squared_distance(from, place); to <= projection)
      projection = to, projected = {place.x(), place.y(), place.z()};
  }
  return corner < projection ? at_corner : projected;
}

}  // namespace sinew

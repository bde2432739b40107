// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/mesh/face_queries.h>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Simple_cartesian.h>
#include <algorithm>
#include <cmath>
#include <vector>

#include <sinew/core/error.h>
#include <sinew/mesh/surface.h>

namespace sinew {

namespace {

// Distances are rounded anyway, and no side is decided by them.
using RoundedKernel = CGAL::Simple_cartesian<double>;
using RoundedFaces = std::vector<RoundedKernel::Triangle_3>;
using RoundedPrimitive = CGAL::AABB_triangle_primitive<RoundedKernel, RoundedFaces::const_iterator>;
using Boxes = CGAL::AABB_tree<CGAL::AABB_traits<RoundedKernel, RoundedPrimitive>>;

RoundedKernel::Point_3 rounded_point(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

}  // namespace

struct NearestFace::Tree {
  RoundedFaces faces;
  std::vector<std::size_t> number;  ///< number of each face in the surface
  Boxes boxes;
};

NearestFace::NearestFace(const Triangles& surface) : tree_(std::make_unique<Tree>()) {
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    if (!(face_area(surface, surface.faces[f]) > 0)) continue;
    const auto& [a, b, c] = surface.faces[f];
    tree_->faces.emplace_back(rounded_point(surface.points[a]), rounded_point(surface.points[b]),
                              rounded_point(surface.points[c]));
    tree_->number.push_back(f);
  }
  if (tree_->faces.empty())
    throw bad_input("the surface has no face with an area", "use a mesh that encloses a volume");
  tree_->boxes.rebuild(tree_->faces.cbegin(), tree_->faces.cend());
  tree_->boxes.accelerate_distance_queries();
}

NearestFace::~NearestFace() = default;
NearestFace::NearestFace(NearestFace&&) noexcept = default;
NearestFace& NearestFace::operator=(NearestFace&&) noexcept = default;

NearestOnFaces NearestFace::to(const Vec3& point) const {
  const auto found = tree_->boxes.closest_point_and_primitive(rounded_point(point));
  const auto face = static_cast<std::size_t>(found.second - tree_->faces.cbegin());
  return {{found.first.x(), found.first.y(), found.first.z()}, tree_->number[face]};
}

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Faces = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Faces::const_iterator>;
using Traits = CGAL::AABB_traits<Kernel, Primitive>;
using Tree = CGAL::AABB_tree<Traits>;
using Node = CGAL::AABB_node<Traits>;

constexpr int places = 2000, stride = 617;  // coprime: any first part of them is spread as well
constexpr double thin_fraction = 0.01;
// Boxes visited by all lines, some seconds: hundreds per line are usual, in fans of needles all.
constexpr std::size_t max_boxes = 20'000'000;

Kernel::Point_3 point_of(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

struct Probing {
  int face;
  Vec3 point, inward;
};

/// Points that each represent the same area, in scattered order.
std::vector<Probing> spread(const Triangles& surface) {
  std::vector<double> until;  // cumulative area, including each face
  double sum = 0;
  for (const auto& face : surface.faces) until.push_back(sum += face_area(surface, face));
  std::vector<Probing> result;
  for (int i = 0; i < places && sum > 0; ++i) {
    const int k = i * stride % places;
    const auto found = std::upper_bound(until.begin(), until.end(), (k + 0.5) / places * sum);
    const int face = static_cast<int>(std::min(found, until.end() - 1) - until.begin());
    const auto& [a, b, c] = surface.faces[face];
    double ignored;  // inside large faces, a sequence that fills the plane evenly
    double u = std::modf(k * 0.7548776662466927, &ignored);
    double v = std::modf(k * 0.5698402909980532, &ignored);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const Vec3 &p = surface.points[a], &q = surface.points[b], &r = surface.points[c];
    result.push_back({face, p + u * (q - p) + v * (r - p),
                      -area_vector(surface, surface.faces[face]).normalized()});
  }
  return result;
}

/// Collects the faces that a line meets in a traversal of the tree.
struct Probe {
  bool go_further() const { return true; }
  bool do_intersect(const Kernel::Line_3& line, const Node& node) {
    ++boxes;
    return CGAL::do_intersect(line, node.bbox());
  }
  void intersection(const Kernel::Line_3& line, const Primitive& face) {
    if (CGAL::do_intersect(line, face.datum())) met.push_back(face.id());
  }

  std::size_t boxes = 0;
  std::vector<Faces::const_iterator> met;
};

/// A crossing of a line with a face: distance, and whether the line leaves the body there.
struct Crossing {
  double distance;
  int out;  ///< 1, or -1 where it enters
};

class Rays {
 public:
  explicit Rays(const Triangles& surface) : surface_(surface) {
    const std::vector<bool> flat = flat_faces(surface);
    for (std::size_t i = 0; i < surface.faces.size(); ++i) {
      if (flat[i]) continue;  // lines along them have no crossing
      const auto& [a, b, c] = surface.faces[i];
      faces_.emplace_back(point_of(surface.points[a]), point_of(surface.points[b]),
                          point_of(surface.points[c]));
      face_.push_back(static_cast<int>(i));
    }
    tree_.rebuild(faces_.cbegin(), faces_.cend());
  }

  /// Distance from a point to where as many parts are left as were entered; nothing where the point
  /// is inside another part, or the line does not leave.
  std::optional<double> thickness(const Probing& place) {
    std::vector<Crossing> crossings = crossings_of(place);
    std::sort(crossings.begin(), crossings.end(),
              [](const Crossing& a, const Crossing& b) { return a.distance < b.distance; });
    int outside = 0, parts = 1;
    for (const Crossing& crossing : crossings)
      if (crossing.distance < 0) outside -= crossing.out;  // behind the point
    if (outside != 0) return std::nullopt;
    for (const Crossing& crossing : crossings)
      if (crossing.distance >= 0 && (parts -= crossing.out) == 0) return crossing.distance;
    return std::nullopt;
  }

  std::size_t boxes() const { return boxes_; }

 private:
  std::vector<Crossing> crossings_of(const Probing& place) {
    const Kernel::Point_3 from = point_of(place.point);
    Probe probe;
    tree_.traversal(Kernel::Line_3(from, point_of(place.point + place.inward) - from), probe);
    boxes_ += probe.boxes;
    std::vector<Crossing> crossings;
    for (const Faces::const_iterator& met : probe.met) {
      const int face = face_[static_cast<std::size_t>(met - faces_.cbegin())];
      const Vec3 normal = area_vector(surface_, surface_.faces[face]);
      const double slope = normal.dot(place.inward);
      if (face == place.face || slope == 0) continue;
      const Vec3& corner = surface_.points[surface_.faces[face][0]];
      crossings.push_back({normal.dot(corner - place.point) / slope, slope > 0 ? 1 : -1});
    }
    return crossings;
  }

  const Triangles& surface_;
  Faces faces_;
  std::vector<int> face_;  ///< the surface's face of each of them
  Tree tree_;
  std::size_t boxes_ = 0;
};

}  // namespace

std::optional<double> thinnest_part(const Triangles& surface) {
  Rays rays(surface);
  std::vector<double> found;
  std::size_t tried = 0;
  for (const Probing& place : spread(surface)) {
    if (rays.boxes() > max_boxes) break;
    ++tried;
    if (const auto thickness = rays.thickness(place)) found.push_back(*thickness);
  }
  if (found.empty() || 2 * found.size() < tried) return std::nullopt;
  const auto rank = found.begin() +
                    static_cast<std::ptrdiff_t>(thin_fraction * static_cast<double>(found.size()));
  std::nth_element(found.begin(), rank, found.end());
  return *rank;
}

std::vector<bool> flat_faces(const Triangles& surface) {
  const auto point = [&](int i) {
    const Vec3& p = surface.points[i];
    return Kernel::Point_3(p.x(), p.y(), p.z());
  };
  std::vector<bool> flat(surface.faces.size());
  for (std::size_t i = 0; i < flat.size(); ++i) {
    const auto& [a, b, c] = surface.faces[i];
    flat[i] = CGAL::collinear(point(a), point(b), point(c));
  }
  return flat;
}

}  // namespace sinew

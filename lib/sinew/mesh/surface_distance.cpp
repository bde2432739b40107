// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/mesh/surface_distance.h>

#include <algorithm>
#include <string>
#include <vector>

#include <sinew/core/error.h>
#include <sinew/core/parallel.h>
#include <sinew/mesh/face_queries.h>
#include <sinew/mesh/surface.h>
#include <sinew/mesh/winding.h>

namespace sinew {

namespace {

// Relative to the surface's size: closer points have no direction to the surface.
constexpr double nearness = 1e-9;

std::vector<Corners> corners_of(const Triangles& surface) {
  std::vector<Corners> corners;
  for (const auto& [a, b, c] : surface.faces)
    corners.push_back({surface.points[a], surface.points[b], surface.points[c]});
  return corners;
}

}  // namespace

struct SurfaceDistance::Tree {
  Triangles surface;
  double size;  ///< of its box, m
  Winding winding;
  NearestFace nearest;
};

SurfaceDistance::SurfaceDistance(const Surface& surface) {
  if (!surface.closed())
    throw bad_input(
        "the surface is not closed (holes: " + std::to_string(surface.border.holes) + ")",
        "close them, or use a closed mesh");
  const Triangles& faces = surface.triangles;
  tree_ = std::make_unique<Tree>(Tree{faces, bounds(faces.points).diagonal().norm(),
                                      Winding(corners_of(faces)), NearestFace(faces)});
}

SurfaceDistance::~SurfaceDistance() = default;
SurfaceDistance::SurfaceDistance(SurfaceDistance&&) noexcept = default;
SurfaceDistance& SurfaceDistance::operator=(SurfaceDistance&&) noexcept = default;

NearestPlace SurfaceDistance::from(const Vec3& point) const {
  const NearestOnFaces found = tree_->nearest.to(point);
  const Vec3 offset = point - found.place;
  const double distance = offset.norm();
  if (distance < nearness * tree_->size)
    return {0, area_vector(tree_->surface, tree_->surface.faces[found.face]).normalized()};
  const int inside = tree_->winding.around(point).value_or(0);
  if (inside > 0) return {-distance, -offset / distance};
  return {distance, offset / distance};
}

namespace {

constexpr std::size_t piece = 256;

// Exact for quadratics over a triangle.
constexpr double corner_weight = 1.0 / 12, center_weight = 3.0 / 4;

/// place(i) for all i < count, and the distance of each from a surface.
template <class Place>
std::vector<double> distances(std::size_t count, const NearestFace& to, const Place& place) {
  std::vector<double> found(count);
  parallel_for(count, piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 at = place(i);
      found[i] = (to.to(at).place - at).norm();
    }
  });
  return found;
}

struct OneWay {
  double farthest = 0, integral = 0, area = 0;
};

OneWay one_way(const Triangles& from, const NearestFace& to) {
  const auto corner = [&](std::size_t i) -> Vec3 { return from.points[i]; };
  const auto center = [&](std::size_t f) -> Vec3 {
    const auto& [a, b, c] = from.faces[f];
    return (from.points[a] + from.points[b] + from.points[c]) / 3;
  };
  const auto at_corners = distances(from.points.size(), to, corner);
  const auto at_centers = distances(from.faces.size(), to, center);
  OneWay all;
  for (std::size_t f = 0; f < from.faces.size(); ++f) {  // in order, for the same bits
    const double area = face_area(from, from.faces[f]);
    double sum = center_weight * at_centers[f];
    all.farthest = std::max(all.farthest, at_centers[f]);
    for (const int i : from.faces[f]) {
      sum += corner_weight * at_corners[i];
      all.farthest = std::max(all.farthest, at_corners[i]);
    }
    all.integral += area * sum;
    all.area += area;
  }
  return all;
}

}  // namespace

SurfaceGap surface_gap(const Triangles& one, const Triangles& other) {
  const OneWay there = one_way(one, NearestFace(other)), back = one_way(other, NearestFace(one));
  return {std::max(there.farthest, back.farthest),
          (there.integral + back.integral) / (there.area + back.area)};
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/mesh/surface_distance.h>

#include <string>
#include <vector>

#include <sinew/core/error.h>
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
  double size;  ///< diagonal of its box, m
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

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/surface_distance.h"

#include <string>
#include <vector>

#include "core/error.h"
#include "mesh/measures.h"
#include "mesh/nearest_face.h"
#include "mesh/winding.h"

namespace sinew {
namespace {

// Nearer to the surface than this, over its size, the way to it has no direction.
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
  const Vec3 way = point - found.place;
  const double distance = way.norm();
  if (distance < nearness * tree_->size)
    return {0, area_vector(tree_->surface, tree_->surface.faces[found.face]).normalized()};
  const int inside = tree_->winding.around(point).value_or(0);
  if (inside > 0) return {-distance, -way / distance};
  return {distance, way / distance};
}

}  // namespace sinew

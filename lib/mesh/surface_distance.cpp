// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/surface_distance.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <string>
#include <vector>

#include "core/error.h"
#include "mesh/winding.h"

namespace sinew {
namespace {

// Distances are rounded anyway, and nobody asks which side of anything they decide.
using Kernel = CGAL::Simple_cartesian<double>;
using Faces = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Faces::const_iterator>;
using Boxes = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

// Nearer to the surface than this, over its size, the way to it has no direction.
constexpr double nearness = 1e-9;

Kernel::Point_3 point_of(const Vec3& p) { return {p.x(), p.y(), p.z()}; }
Vec3 vec3_of(const Kernel::Point_3& p) { return {p.x(), p.y(), p.z()}; }

std::vector<Corners> corners_of(const Triangles& surface) {
  std::vector<Corners> corners;
  for (const auto& [a, b, c] : surface.faces)
    corners.push_back({surface.points[a], surface.points[b], surface.points[c]});
  return corners;
}

}  // namespace

struct SurfaceDistance::Tree {
  explicit Tree(const std::vector<Corners>& corners) : winding(corners) {
    for (const Corners& face : corners) {
      const Vec3 area = (face[1] - face[0]).cross(face[2] - face[0]);
      if (!(area.norm() > 0)) continue;
      faces.emplace_back(point_of(face[0]), point_of(face[1]), point_of(face[2]));
      normals.push_back(area.normalized());
      for (const Vec3& corner : face) box.extend(corner);
    }
    boxes.rebuild(faces.cbegin(), faces.cend());
    if (!faces.empty()) boxes.accelerate_distance_queries();
  }

  Faces faces;
  Points normals;
  Box box;
  Winding winding;
  Boxes boxes;
};

SurfaceDistance::SurfaceDistance(const Surface& surface) {
  if (!surface.closed())
    throw bad_input(
        "the surface is not closed (holes: " + std::to_string(surface.border.holes) + ")",
        "close them, or use a closed mesh");
  tree_ = std::make_unique<Tree>(corners_of(surface.triangles));
  if (tree_->faces.empty())
    throw bad_input("the surface has no face with an area", "use a mesh that encloses a volume");
}

SurfaceDistance::~SurfaceDistance() = default;
SurfaceDistance::SurfaceDistance(SurfaceDistance&&) noexcept = default;
SurfaceDistance& SurfaceDistance::operator=(SurfaceDistance&&) noexcept = default;

NearestPlace SurfaceDistance::from(const Vec3& point) const {
  const auto found = tree_->boxes.closest_point_and_primitive(point_of(point));
  const Vec3 way = point - vec3_of(found.first);
  const double distance = way.norm();
  const auto face = static_cast<std::size_t>(found.second - tree_->faces.cbegin());
  if (distance < nearness * tree_->box.diagonal().norm()) return {0, tree_->normals[face]};
  const int inside = tree_->winding.around(point).value_or(0);
  if (inside > 0) return {-distance, -way / distance};
  return {distance, way / distance};
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/nearest_face.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <vector>

#include "core/error.h"
#include "mesh/measures.h"

namespace sinew {
namespace {

// Distances are rounded anyway, and nobody asks which side of anything they decide.
using Kernel = CGAL::Simple_cartesian<double>;
using Faces = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Faces::const_iterator>;
using Boxes = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Kernel::Point_3 point_of(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

}  // namespace

struct NearestFace::Tree {
  Faces faces;
  std::vector<std::size_t> number;  ///< of each in the surface
  Boxes boxes;
};

NearestFace::NearestFace(const Triangles& surface) : tree_(std::make_unique<Tree>()) {
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    if (!(face_area(surface, surface.faces[f]) > 0)) continue;
    const auto& [a, b, c] = surface.faces[f];
    tree_->faces.emplace_back(point_of(surface.points[a]), point_of(surface.points[b]),
                              point_of(surface.points[c]));
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
  const auto found = tree_->boxes.closest_point_and_primitive(point_of(point));
  const auto face = static_cast<std::size_t>(found.second - tree_->faces.cbegin());
  return {{found.first.x(), found.first.y(), found.first.z()}, tree_->number[face]};
}

}  // namespace sinew

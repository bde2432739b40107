// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/element_places.h>

#include <algorithm>

#include <sinew/core/cell_grid.h>
#include <sinew/core/error.h>
#include <sinew/core/parallel.h>

namespace sinew {
namespace {

constexpr double within = 1e-6;  // fraction of an element: nothing is nearer
constexpr int max_iterations = 30;
constexpr double farthest = 4;  // local coordinates: beyond, Newton's method is lost

/// Local coordinates of a point, by Newton's method from the middle.
Vec3 local_coordinates(const VolumeMesh& mesh, const VolumeElement& element, const Vec3& point) {
  constexpr double small = 1e-12;
  Vec3 local = is_hexahedron(element.kind) ? Vec3(Vec3::Zero()) : Vec3::Constant(0.25);
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    const ShapeFunctions at = shape_functions(element.kind, local);
    Vec3 place = Vec3::Zero();
    Mat3 slope = Mat3::Zero();
    for (std::size_t k = 0; k < element.used().size(); ++k) {
      place += at.value[k] * mesh.nodes[element.nodes[k]];
      slope += mesh.nodes[element.nodes[k]] * at.slope[k].transpose();
    }
    const Vec3 step = slope.inverse() * (point - place);
    if (!step.allFinite()) break;
    local += step;
    if (step.norm() < small) break;
    if (local.cwiseAbs().maxCoeff() > farthest) break;
  }
  return local;
}

class Search {
 public:
  explicit Search(const VolumeMesh& mesh) : mesh_(mesh), grid_(centers_of(mesh), reach_of(mesh)) {
    for (const VolumeElement& element : mesh.elements) {
      Box& box = boxes_.emplace_back();
      for (const std::uint32_t node : element.used()) box.extend(mesh.nodes[node]);
    }
  }

  ElementPlace place_of(const Vec3& point) const {
    ElementPlace best;
    grid_.for_each_near(point, [&](std::uint32_t e) {
      if (best.outside > within && boxes_[e].contains(point)) take(e, point, best);
    });
    if (best.outside <= within) return best;
    grid_.for_each_near(point, [&](std::uint32_t e) { take(e, point, best); });
    return best;
  }

 private:
  static Points centers_of(const VolumeMesh& mesh) {
    if (mesh.elements.empty())
      throw bad_input("a mesh has no elements", "give the result of a body");
    Points centers;
    for (const VolumeElement& element : mesh.elements) centers.push_back(center_of(mesh, element));
    return centers;
  }

  /// The farthest node from the center of its element, and a little more.
  static double reach_of(const VolumeMesh& mesh) {
    double reach = 0;
    for (const VolumeElement& element : mesh.elements)
      for (const std::uint32_t node : element.used())
        reach = std::max(reach, (mesh.nodes[node] - center_of(mesh, element)).norm());
    return 1.01 * reach;
  }

  void take(std::uint32_t e, const Vec3& point, ElementPlace& best) const {
    const VolumeElement& element = mesh_.elements[e];
    const Vec3 local = local_coordinates(mesh_, element, point);
    const double beyond = outside_by(element.kind, local);
    if (!(beyond < best.outside) || !(beyond < 1)) return;
    best = {e, shape_functions(element.kind, local).value, beyond};
  }

  const VolumeMesh& mesh_;
  CellGrid grid_;
  std::vector<Box> boxes_;
};

}  // namespace

std::vector<ElementPlace> places_in(const VolumeMesh& mesh, const Points& points) {
  const Search search(mesh);
  std::vector<ElementPlace> places(points.size());
  parallel_for(points.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) places[i] = search.place_of(points[i]);
  });
  return places;
}

}  // namespace sinew

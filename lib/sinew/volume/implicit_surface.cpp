// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/volume/implicit_surface.h>

#include <cmath>

#include <sinew/core/volume_mesh.h>
#include <sinew/volume/detail/scaffold.h>
#include <sinew/volume/detail/stuffing.h>

namespace sinew {
namespace {

constexpr double cut_at = 1e-9;  // fraction of an edge: how exactly it is cut
constexpr int max_rounds = 60;

/// Where a segment crosses the surface, by the Illinois method (Dowell and Jarratt 1971).
double zero_of(const DistanceOf& distance, const Vec3& inside, const Vec3& outside) {
  double low = 0, high = 1;
  double below = distance(inside), above = distance(outside);
  int last = 0;
  for (int round = 0; round < max_rounds && high - low > cut_at && below != above; ++round) {
    const double at = low + (high - low) * below / (below - above);
    const double there = distance(inside + at * (outside - inside));
    if (std::abs(there) <= cut_at * (outside - inside).norm()) return at;
    if (there < 0) {
      low = at, below = there;
      if (last < 0) above /= 2;
      last = -1;
    } else {
      high = at, above = there;
      if (last > 0) below /= 2;
      last = 1;
    }
  }
  return (low + high) / 2;
}

Triangles skin_of(const VolumeCells& body) {
  const VolumeMesh mesh = mesh_of(body);
  Triangles surface;
  std::vector<int> number(mesh.nodes.size(), -1);
  for (const ElementFace& face : boundary_faces(mesh)) {
    std::array<int, 3> corners{};
    const std::vector<std::uint32_t> nodes = face_nodes(mesh.elements[face.element], face.face);
    for (std::size_t k = 0; k < 3; ++k) {
      int& at = number[nodes[k]];
      if (at < 0) {
        at = static_cast<int>(surface.points.size());
        surface.points.push_back(mesh.nodes[nodes[k]]);
      }
      corners[k] = at;
    }
    surface.faces.push_back({corners[0], corners[2], corners[1]});
  }
  return surface;
}

}  // namespace

Triangles implicit_surface(const DistanceOf& distance, const Box& box, double edge) {
  const Vec3 beyond = Vec3::Constant(2 * edge);
  const Honeycomb honeycomb(
      lattice_in(Box(box.min() - beyond, box.max() + beyond), Packing::fcc, edge / 2),
      [&](const Vec3& site) { return distance(site) < 0; });
  const Scaffold scaffold = honeycomb.around(0);
  if (scaffold.cells.empty()) return {};
  return skin_of(
      stuffed(scaffold,
              {[&](const Vec3& point) { return distance(point) < 0; },
               [&](const Vec3& in, const Vec3& out) { return zero_of(distance, in, out); }},
              edge / 2));
}

}  // namespace sinew

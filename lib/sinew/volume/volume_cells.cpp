// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/volume/volume_cells.h>

#include <algorithm>
#include <cmath>

#include <sinew/core/error.h>
#include <sinew/core/particles.h>
#include <sinew/fill/filled_sites.h>
#include <sinew/volume/detail/border_fit.h>
#include <sinew/volume/detail/inside_space.h>
#include <sinew/volume/detail/scaffold.h>
#include <sinew/volume/detail/stuffing.h>

namespace sinew {
namespace {

void append(const VolumeCells& part, VolumeCells& body) {
  const auto first = static_cast<std::uint32_t>(body.points.size());
  body.points.insert(body.points.end(), part.points.begin(), part.points.end());
  body.id.insert(body.id.end(), part.id.begin(), part.id.end());
  body.beside.insert(body.beside.end(), part.beside.begin(), part.beside.end());
  for (const auto& [a, b, c, d] : part.cells)
    body.cells.push_back({first + a, first + b, first + c, first + d});
}

VolumeCells fitted(const Scaffold& scaffold, const InsideSpace& inside, double radius) {
  const BodyBorder border{
      [&](const Vec3& point) { return inside.contains(point); },
      [&](const Vec3& from, const Vec3& to) { return inside.crossing(from, to); }};
  VolumeCells body = stuffed(scaffold, border, radius);
  fit_border(body, inside, radius);
  return body;
}

VolumeCells on_lattice(const BodySpace& space, const PackOptions& options, const Points& rest) {
  const Honeycomb honeycomb(space, options, rest);
  VolumeCells body;
  for (int one = 0; one < honeycomb.bodies(); ++one) {
    const Scaffold scaffold = honeycomb.around(one);
    if (scaffold.cells.empty()) continue;
    const InsideSpace inside(honeycomb.faces_of(space.surface, one), options.thickness);
    append(fitted(scaffold, inside, *options.radius), body);
  }
  return body;
}

VolumeCells off_lattice(const BodySpace& space, const PackOptions& options, const Points& rest) {
  const InsideSpace inside(space.surface, options.thickness);
  return fitted(delaunay(rest, *options.radius, inside), inside, *options.radius);
}

}  // namespace

VolumeCells volume_cells(const Surface& surface, const PackOptions& options, const Points& rest) {
  if (rest.empty()) throw bad_input("the body has no particles", "make its radius smaller");
  const BodySpace space(surface, options);
  Points near = rest;
  for (Vec3& point : near) point = space.placement.to_lattice(point);
  VolumeCells body = is_lattice(options.packing) ? on_lattice(space, options, near)
                                                 : off_lattice(space, options, near);
  for (std::size_t i = 0; i < body.points.size(); ++i)
    body.points[i] =
        body.id[i] < 0 ? space.placement.from_lattice(body.points[i]) : rest[body.id[i]];
  return body;
}

DihedralAngles dihedral_angles(const std::array<Vec3, 4>& corners) {
  std::array<Vec3, 4> normals;  // normals of the opposite faces, all outward or all inward
  for (int v = 0; v < 4; ++v) {
    const Vec3 &a = corners[(v + 1) % 4], &b = corners[(v + 2) % 4], &c = corners[(v + 3) % 4];
    normals[v] = (b - a).cross(c - a) * (v % 2 == 0 ? 1 : -1);
  }
  DihedralAngles angles;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < i; ++j) {
      const double angle = 180 - degrees(std::atan2(normals[i].cross(normals[j]).norm(),
                                                    normals[i].dot(normals[j])));
      angles.smallest = std::min(angles.smallest, angle);
      angles.largest = std::max(angles.largest, angle);
    }
  return angles;
}

CellQuality quality_of(const VolumeCells& body) {
  CellQuality quality;
  quality.smallest_volume = body.cells.empty() ? 0 : HUGE_VAL;
  for (const Cell& cell : body.cells) {
    const double volume = volume_of(body.points, cell);
    quality.volume += volume;
    quality.smallest_volume = std::min(quality.smallest_volume, volume);
    std::array<Vec3, 4> corners;
    for (int v = 0; v < 4; ++v) corners[v] = body.points[cell[v]];
    const DihedralAngles angles = dihedral_angles(corners);
    quality.angles.smallest = std::min(quality.angles.smallest, angles.smallest);
    quality.angles.largest = std::max(quality.angles.largest, angles.largest);
  }
  return quality;
}

VolumeMesh mesh_of(const VolumeCells& body) {
  VolumeMesh mesh{body.points, {}};
  for (const Cell& cell : body.cells) {
    VolumeElement element;
    std::copy(cell.begin(), cell.end(), element.nodes.begin());
    mesh.elements.push_back(element);
  }
  return mesh;
}

Dataset dataset_of(const VolumeCells& body) {
  Dataset data;
  data.points = body.points;
  data.kind = CellKind::tetrahedron;
  data.connectivity.reserve(4 * body.cells.size());
  for (const Cell& cell : body.cells)
    data.connectivity.insert(data.connectivity.end(), cell.begin(), cell.end());
  data.point_columns = {column("id", body.id)};
  return data;
}

}  // namespace sinew

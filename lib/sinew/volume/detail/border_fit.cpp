// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/volume/detail/border_fit.h>

#include <algorithm>
#include <cmath>

#include <sinew/core/parallel.h>
#include <sinew/volume/detail/creases.h>

namespace sinew {
namespace {

using Face = BorderFace;

constexpr std::size_t faces_at_a_time = 64;
constexpr double reach = 0.8;         // radii: where the surface is looked for from a face
constexpr double mean_of_gap = 0.75;  // over a face, relative to its center, of a round surface
constexpr double farthest = 0.25;     // radii that a point may move
constexpr double flat_enough = 12;    // degrees: cells with smaller angles become no flatter
constexpr double flat_gap = 1e-4;     // radii: below, faces are plane

/// The four faces of a positive cell, outward.
std::array<Face, 4> faces_of(const Cell& cell) {
  const auto [a, b, c, d] = cell;
  return {{{a, c, b}, {a, b, d}, {b, c, d}, {a, d, c}}};
}

Vec3 area_of(const VolumeCells& body, const Face& face) {
  const Vec3 &a = body.points[face[0]], &b = body.points[face[1]], &c = body.points[face[2]];
  return (b - a).cross(c - a) / 2;
}

/// Distance of the surface from a face's center along its normal, m; 0 where it is not near.
double gap_of(const VolumeCells& body, const Face& face, const InsideSpace& space, double radius) {
  const Vec3 center = (body.points[face[0]] + body.points[face[1]] + body.points[face[2]]) / 3;
  const Vec3 step = reach * radius * area_of(body, face).normalized();
  if (!space.contains(center - step) || space.contains(center + step)) return 0;
  return (2 * space.crossing(center - step, center + step) - 1) * reach * radius;
}

}  // namespace

CellsOfPoint::CellsOfPoint(const VolumeCells& body) : first_(body.points.size() + 1) {
  for (const Cell& cell : body.cells)
    for (const std::uint32_t v : cell) ++first_[v + 1];
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  cells_.resize(first_.back());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t c = 0; c < body.cells.size(); ++c)
    for (const std::uint32_t v : body.cells[c]) cells_[next[v]++] = c;
}

/// Negative where a cell is inside out.
double CellsOfPoint::smallest_angle(const VolumeCells& body, std::uint32_t point) const {
  double smallest = 180;
  for (std::size_t k = first_[point]; k < first_[point + 1]; ++k) {
    const Cell& cell = body.cells[cells_[k]];
    if (volume_of(body.points, cell) <= 0) return -1;
    std::array<Vec3, 4> corners;
    for (int v = 0; v < 4; ++v) corners[v] = body.points[cell[v]];
    smallest = std::min(smallest, dihedral_angles(corners).smallest);
  }
  return smallest;
}

bool CellsOfPoint::move(VolumeCells& body, std::uint32_t point, const Vec3& place,
                        double flat) const {
  const Vec3 before = body.points[point];
  const double angle = smallest_angle(body, point);
  body.points[point] = place;
  if (smallest_angle(body, point) >= std::min(angle, flat)) return true;
  body.points[point] = before;
  return false;
}

std::vector<Face> border_of(const VolumeCells& body) {
  struct Sorted {
    Face key, face;
  };
  std::vector<Sorted> faces;
  for (const Cell& cell : body.cells)
    for (const Face& face : faces_of(cell)) {
      Face key = face;
      std::sort(key.begin(), key.end());
      faces.push_back({key, face});
    }
  std::sort(faces.begin(), faces.end(),
            [](const Sorted& a, const Sorted& b) { return a.key < b.key; });
  std::vector<Face> border;
  for (std::size_t i = 0, end; i < faces.size(); i = end) {
    for (end = i + 1; end < faces.size() && faces[end].key == faces[i].key;) ++end;
    if (end == i + 1) border.push_back(faces[i].face);
  }
  return border;
}

void fit_border(VolumeCells& body, const InsideSpace& space, double radius) {
  const std::vector<Face> border = border_of(body);
  const std::vector<char> snapped = snap_to_creases(body, border, space, radius);
  std::vector<double> gap(border.size());
  parallel_for(border.size(), faces_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) gap[f] = gap_of(body, border[f], space, radius);
  });
  std::vector<double> missing(body.points.size()), area(body.points.size());
  Points normal(body.points.size(), Vec3::Zero());
  for (std::size_t f = 0; f < border.size(); ++f) {
    const Vec3 of_face = area_of(body, border[f]);
    for (const std::uint32_t v : border[f]) {
      missing[v] += mean_of_gap * gap[f] * of_face.norm();
      area[v] += of_face.norm();
      normal[v] += of_face;
    }
  }
  const CellsOfPoint cells(body);
  for (std::uint32_t v = 0; v < body.points.size(); ++v) {
    if (area[v] == 0 || body.id[v] >= 0 || snapped[v]) continue;
    const double shift = std::clamp(missing[v] / area[v], -farthest * radius, farthest * radius);
    if (std::abs(shift) > flat_gap * radius)
      cells.move(body, v, body.points[v] + shift * normal[v].normalized(), flat_enough);
  }
}

}  // namespace sinew

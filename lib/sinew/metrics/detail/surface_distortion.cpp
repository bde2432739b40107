// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/detail/surface_distortion.h>

#include <cmath>

#include <sinew/metrics/statistics.h>

namespace sinew {
namespace {

using Corners = std::array<Vec3, 3>;

Corners corners(const Points& points, const std::array<int, 3>& face) {
  return {points[face[0]], points[face[1]], points[face[2]]};
}

Vec3 area_vector(const Corners& c) { return (c[1] - c[0]).cross(c[2] - c[0]) / 2; }

/// Deviation of a ratio from one, in either direction.
double either_way(double ratio) { return std::max(ratio, 1 / ratio); }

/// The two edges from the first corner, in the triangle's own plane; the first along x.
Eigen::Matrix2d flattened(const Corners& c) {
  const Vec3 along = c[1] - c[0], other = c[2] - c[0];
  const double length = along.norm();
  Eigen::Matrix2d edges;
  edges << length, along.dot(other) / length, 0, along.cross(other).norm() / length;
  return edges;
}

double edge_stretch(const Corners& rest, const Corners& now) {
  double worst = 1;
  for (int k = 0; k < 3; ++k) {
    const double before = (rest[(k + 1) % 3] - rest[k]).norm();
    if (before > 0)
      worst = std::max(worst, either_way((now[(k + 1) % 3] - now[k]).norm() / before));
  }
  return worst;
}

/// Statistics of value(face) over the faces that have an area at rest.
template <class Value>
Statistics over_faces(const Triangles& rest, const Points& now, const Value& value) {
  std::vector<double> values(rest.faces.size(), not_measured);
  parallel_for(values.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      const Corners before = corners(rest.points, rest.faces[f]);
      if (area_vector(before).norm() > 0) values[f] = value(before, corners(now, rest.faces[f]));
    }
  });
  Statistics all;
  for (const double one : values)
    if (!std::isnan(one)) all.add(one);
  return all;
}

double flipped_faces(const Triangles& surface) {
  const Points normals = point_normals(surface);
  return statistics(surface.faces.size(),
                    [&](std::size_t f) {
                      const auto& face = surface.faces[f];
                      const Vec3 around = normals[face[0]] + normals[face[1]] + normals[face[2]];
                      return area_vector(corners(surface.points, face)).dot(around) < 0 ? 1.0 : 0.0;
                    })
      .sum;
}

double dirichlet(const Corners& rest, const Corners& now) {
  double sum = 0;
  for (const double s : face_stretches(rest, now)) sum += s * s + 1 / (s * s);
  return sum;
}

}  // namespace

std::array<double, 2> face_stretches(const Corners& rest, const Corners& now) {
  const Eigen::Matrix2d F = flattened(now) * flattened(rest).inverse();
  // Both faces have their first edge along x: F(1, 0) is 0.
  const double like = std::hypot(F(0, 0) + F(1, 1), F(0, 1));
  const double unlike = std::hypot(F(0, 0) - F(1, 1), F(0, 1));
  return {(like + unlike) / 2, std::abs(like - unlike) / 2};
}

SurfaceDistortion surface_distortion(const Triangles& rest, const Points& now) {
  SurfaceDistortion out;
  const Triangles moved{now, rest.faces};
  out.area = area(moved);
  out.edge_stretch = over_faces(rest, now, edge_stretch).max();
  out.area_stretch = over_faces(rest, now, [](const Corners& a, const Corners& b) {
                       return either_way(area_vector(b).norm() / area_vector(a).norm());
                     }).max();
  out.conformal = over_faces(rest, now, [](const Corners& a, const Corners& b) {
                    const auto s = face_stretches(a, b);
                    return s[0] / s[1];
                  }).max();
  const double whole = over_faces(rest, now, [](const Corners& a, const Corners&) {
                         return area_vector(a).norm();
                       }).sum;
  out.dirichlet = over_faces(rest, now,
                             [](const Corners& a, const Corners& b) {
                               return area_vector(a).norm() * dirichlet(a, b);
                             })
                      .sum /
                  whole;
  out.flipped = flipped_faces(moved);
  return out;
}

}  // namespace sinew

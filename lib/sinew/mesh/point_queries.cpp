// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/mesh/point_queries.h>

#include <cmath>
#include <limits>

#include <sinew/core/parallel.h>
#include <sinew/mesh/face_queries.h>
#include <sinew/mesh/winding.h>

namespace sinew {
namespace {

constexpr std::size_t points_at_once = 256;

/// Solid angle of a face over 4 pi (Van Oosterom and Strackee 1983), positive behind the face.
double turn_of(const Triangles& surface, const std::array<int, 3>& face, const Vec3& point) {
  const Vec3 a = surface.points[face[0]] - point, b = surface.points[face[1]] - point,
             c = surface.points[face[2]] - point;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  const double volume = a.dot(b.cross(c));
  const double sides = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  return 2 * std::atan2(volume, sides) / (4 * pi);
}

double sum_of_turns(const Triangles& faces, const Vec3& point) {
  double sum = 0;
  for (const auto& face : faces.faces) sum += turn_of(faces, face, point);
  return sum;
}

/// The winding number of an open surface: that of the closed one less that of its caps.
class OpenWindingNumber {
 public:
  explicit OpenWindingNumber(const Surface& surface)
      : surface_(surface), closed_(winding_of(surface)), faces_(surface.triangles) {
    near_ = 1e-10 * bounds(surface.triangles.points).diagonal().norm();
  }

  double around(const Vec3& point) const {
    if (const auto whole = closed_.around(point))
      return surface_.closed() ? *whole : *whole - sum_of_turns(surface_.caps, point);
    // On a face or on a cap, which is no part of the surface.
    if ((faces_.to(point).place - point).norm() <= near_)
      return std::numeric_limits<double>::quiet_NaN();
    return sum_of_turns(surface_.triangles, point);
  }

 private:
  const Surface& surface_;
  Winding closed_;
  NearestFace faces_;
  double near_;
};

template <class Value>
std::vector<double> value_at_each(const Points& points, const Value& value) {
  std::vector<double> values(points.size());
  parallel_for(points.size(), points_at_once, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) values[i] = value(points[i]);
  });
  return values;
}

}  // namespace

std::vector<double> distances(const Triangles& surface, const Points& points) {
  const NearestFace nearest(surface);
  return value_at_each(points,
                       [&](const Vec3& point) { return (nearest.to(point).place - point).norm(); });
}

std::vector<double> winding_numbers(const Surface& surface, const Points& points) {
  const OpenWindingNumber winding(surface);
  return value_at_each(points, [&](const Vec3& point) { return winding.around(point); });
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/world/shape_surface.h"

#include <cmath>

namespace sinew {
namespace {

constexpr int meridians = 24, parallels = 6;  // per hemisphere: within 1 % of the radius

Triangles surface_of(const PlaneShape& plane, double size) {
  const Mat3 frame = frame_along(plane.normal);
  const Vec3 a = size / 2 * frame.col(1), b = size / 2 * frame.col(2);
  const Vec3& p = plane.point;
  return {{p - a - b, p + a - b, p + a + b, p - a + b}, {{0, 1, 2}, {0, 2, 3}}};
}

/// A ball pulled apart along an axis: rings of points from the pole at b to the one at a.
Triangles rounded(const Vec3& a, const Vec3& b, double radius) {
  const Vec3 way = b - a;
  const Mat3 frame = frame_along(way.norm() > 0 ? way : Vec3::UnitZ());
  Triangles surface;
  surface.points.push_back(b + radius * frame.col(0));
  for (int ring = 1; ring <= 2 * parallels; ++ring) {  // the equator twice: once at either end
    const int step = ring <= parallels ? ring : ring - 1;
    const double polar = pi / 2 * step / parallels;
    for (int k = 0; k < meridians; ++k) {
      const double turn = 2 * pi * k / meridians;
      const Vec3 across = std::cos(turn) * frame.col(1) + std::sin(turn) * frame.col(2);
      surface.points.push_back((ring <= parallels ? b : a) +
                               radius *
                                   (std::cos(polar) * frame.col(0) + std::sin(polar) * across));
    }
  }
  surface.points.push_back(a - radius * frame.col(0));
  const int last = static_cast<int>(surface.points.size()) - 1;
  const auto at = [](int ring, int k) { return 1 + (ring - 1) * meridians + k % meridians; };
  for (int k = 0; k < meridians; ++k) {
    surface.faces.push_back({0, at(1, k), at(1, k + 1)});
    for (int ring = 1; ring < 2 * parallels; ++ring) {
      surface.faces.push_back({at(ring, k), at(ring + 1, k), at(ring + 1, k + 1)});
      surface.faces.push_back({at(ring, k), at(ring + 1, k + 1), at(ring, k + 1)});
    }
    surface.faces.push_back({at(2 * parallels, k), last, at(2 * parallels, k + 1)});
  }
  return surface;
}

Triangles surface_of(const SphereShape& ball, double) {
  return rounded(ball.centre, ball.centre, ball.radius);
}

Triangles surface_of(const CapsuleShape& capsule, double) {
  return rounded(capsule.a, capsule.b, capsule.radius);
}

Triangles surface_of(const BoxShape& box, double) {
  Triangles surface;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    surface.points.push_back(box.centre + box.rotation * sign.cwiseProduct(box.half));
  }
  surface.faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                   {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return surface;
}

Triangles surface_of(const MeshShape&, double) { return {}; }

}  // namespace

Triangles surface_of(const Shape& shape, double size) {
  return std::visit([size](const auto& form) { return surface_of(form, size); }, shape);
}

}  // namespace sinew

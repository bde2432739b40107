// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/world/shapes.h>

#include <algorithm>
#include <cmath>

#include <sinew/core/error.h>
#include <sinew/core/text.h>
#include <sinew/rig/skeleton.h>

namespace sinew {

namespace {

// Axes given with rounded digits are accepted; the distance is then wrong by at most this fraction.
constexpr double square_enough = 1e-6;
// Closer than this to a capsule's segment, in radii, a direction is rounding.
constexpr double rounding_of_lengths = 1e-9;

SignedDistance from_point(const Vec3& offset, double radius, const Vec3& otherwise) {
  const double length = offset.norm();
  return {length - radius, length > 0 ? Vec3(offset / length) : otherwise};
}

SignedDistance distance_to(const PlaneShape& plane, const Vec3& point) {
  const Vec3 normal = plane.normal.normalized();
  return {normal.dot(point - plane.point), normal};
}

SignedDistance distance_to(const SphereShape& sphere, const Vec3& point) {
  return from_point(point - sphere.center, sphere.radius, Vec3::UnitZ());
}

SignedDistance distance_to(const CapsuleShape& capsule, const Vec3& point) {
  const Vec3 along = capsule.b - capsule.a;
  const double squared = along.squaredNorm();
  if (!(squared > 0)) return from_point(point - capsule.a, capsule.radius, Vec3::UnitZ());
  const double fraction = std::clamp((point - capsule.a).dot(along) / squared, 0.0, 1.0);
  const Vec3 offset = point - (capsule.a + fraction * along);
  // On the axis the direction would be rounding alone, and might be that of the axis.
  if (offset.norm() < rounding_of_lengths * capsule.radius)
    return {offset.norm() - capsule.radius, frame_along(along).col(1)};
  return from_point(offset, capsule.radius, Vec3::UnitZ());
}

/// Inside: the nearest face; on ties the first axis, and its positive side.
SignedDistance inside_box(const BoxShape& box, const Vec3& local) {
  Eigen::Index axis = 0;
  const double distance = (local.cwiseAbs() - box.half).maxCoeff(&axis);
  return {distance, (local[axis] < 0 ? -1 : 1) * box.rotation.col(axis)};
}

SignedDistance distance_to(const BoxShape& box, const Vec3& point) {
  const Vec3 local = box.rotation.transpose() * (point - box.center);
  const Vec3 offset = local - local.cwiseMax(-box.half).cwiseMin(box.half);
  if (offset.isZero(0)) return inside_box(box, local);
  const double distance = offset.norm();
  return {distance, box.rotation * (offset / distance)};
}

SignedDistance distance_to(const MeshShape& mesh, const Vec3& point) {
  return mesh.distance(point);
}

void require_shape(bool holds, const std::string& what, const std::string& wrong,
                   const std::string& cure) {
  if (!holds) throw bad_input(what + wrong, cure);
}

void check_size(double size, const std::string& what, const std::string& name) {
  require_shape(is_computable(size) && size > 0, what,
                " has a " + name + " of " + number_text(size), "give a positive number");
}

void check_place(const Vec3& place, const std::string& what) {
  require_shape(is_computable(place), what, " is at a place that is too large or not finite",
                "give finite numbers");
}

void check_solid(const PlaneShape& plane, const std::string& what) {
  check_place(plane.point, what);
  require_shape(is_computable(plane.normal) && plane.normal.norm() > 0, what,
                " is a plane whose normal has no length", "give a direction");
}

void check_solid(const SphereShape& sphere, const std::string& what) {
  check_place(sphere.center, what);
  check_size(sphere.radius, what, "radius");
}

void check_solid(const CapsuleShape& capsule, const std::string& what) {
  check_place(capsule.a, what);
  check_place(capsule.b, what);
  check_size(capsule.radius, what, "radius");
}

void check_solid(const BoxShape& box, const std::string& what) {
  check_place(box.center, what);
  for (const double half : box.half) check_size(half, what, "half edge");
  const Mat3 product = box.rotation.transpose() * box.rotation;
  require_shape((product - Mat3::Identity()).cwiseAbs().maxCoeff() < square_enough, what,
                " is a box whose axes are not square", "give a rotation");
}

void check_solid(const MeshShape& mesh, const std::string& what) {
  require_shape(static_cast<bool>(mesh.distance), what, " is a mesh without distances",
                "give its distance function");
  require_shape(!mesh.bounds.isEmpty() && is_computable(mesh.bounds.min()) &&
                    is_computable(mesh.bounds.max()),
                what, " is a mesh without bounds", "give the box that holds it");
}

}  // namespace

SignedDistance signed_distance(const Shape& shape, const Vec3& point) {
  return std::visit([&](const auto& solid) { return distance_to(solid, point); }, shape);
}

bool may_be_within(const Shape& shape, const Vec3& point, double range) {
  const auto* mesh = std::get_if<MeshShape>(&shape);
  return !mesh || !(mesh->bounds.squaredExteriorDistance(point) >= range * range);
}

namespace {

bool is_near(const Box& bounds, const Box& box, double range) {
  return bounds.squaredExteriorDistance(box) < range * range;
}

bool is_near(const PlaneShape& plane, const Box& box, double range) {
  const Vec3 normal = plane.normal.normalized();
  const double nearest =
      normal.dot(box.center() - plane.point) - normal.cwiseAbs().dot(box.sizes()) / 2;
  return nearest < range;
}

bool is_near(const SphereShape& sphere, const Box& box, double range) {
  const double reach = sphere.radius + range;
  return box.squaredExteriorDistance(sphere.center) < reach * reach;
}

bool is_near(const CapsuleShape& capsule, const Box& box, double range) {
  Box segment(capsule.a);
  segment.extend(capsule.b);
  return is_near(segment, box, capsule.radius + range);
}

bool is_near(const BoxShape& shape, const Box& box, double range) {
  const Vec3 half = shape.rotation.cwiseAbs() * shape.half;
  return is_near(Box(Vec3(shape.center - half), Vec3(shape.center + half)), box, range);
}

bool is_near(const MeshShape& mesh, const Box& box, double range) {
  return is_near(mesh.bounds, box, range);
}

}  // namespace

bool may_be_near(const Shape& shape, const Box& box, double range) {
  const double reach = box.diagonal().norm() / 2 + range;
  return std::visit([&](const auto& solid) { return is_near(solid, box, range); }, shape) &&
         (std::holds_alternative<MeshShape>(shape) ||
          signed_distance(shape, box.center()).distance < reach);
}

void check_shape(const Shape& shape, const std::string& what) {
  std::visit([&](const auto& solid) { check_solid(solid, what); }, shape);
}

namespace {

constexpr int meridians = 24, parallels = 6;  // per hemisphere: to 1 % of the radius

Triangles surface_of(const PlaneShape& plane, double size) {
  const Mat3 frame = frame_along(plane.normal);
  const Vec3 a = size / 2 * frame.col(1), b = size / 2 * frame.col(2);
  const Vec3& p = plane.point;
  return {{p - a - b, p + a - b, p + a + b, p - a + b}, {{0, 1, 2}, {0, 2, 3}}};
}

/// A ball pulled apart along an axis: rings of points from the pole at b to the one at a.
Triangles rounded(const Vec3& a, const Vec3& b, double radius) {
  const Vec3 axis = b - a;
  const Mat3 frame = frame_along(axis.norm() > 0 ? axis : Vec3::UnitZ());
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
  return rounded(ball.center, ball.center, ball.radius);
}

Triangles surface_of(const CapsuleShape& capsule, double) {
  return rounded(capsule.a, capsule.b, capsule.radius);
}

Triangles surface_of(const BoxShape& box, double) {
  Triangles surface;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    surface.points.push_back(box.center + box.rotation * sign.cwiseProduct(box.half));
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

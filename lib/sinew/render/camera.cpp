// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/camera.h>

#include <algorithm>
#include <cmath>

#include <sinew/core/error.h>

namespace sinew {

Mat3 view_from(const Vec3& towards_viewer) {
  const Vec3 back = towards_viewer.normalized();
  const Vec3 right = Vec3::UnitZ().cross(back).normalized();
  Mat3 view;
  view << right.transpose(), back.cross(right).transpose(), back.transpose();
  return view;
}

Mat3 three_quarter_view() { return view_from({0.42, -1, 0.36}); }

Mat3 view_from_above() { return Mat3::Identity(); }

namespace {

/// Calls `add(point, around)`, in m, for all that reaches out.
template <class Add>
void for_each_point(const Snapshot& snapshot, Add&& add_finite) {
  const auto add = [&](const Vec3& point, double around) {
    if (!point.allFinite())
      throw bad_input("a position to draw is not finite", "draw earlier frames of the run");
    add_finite(point, around);
  };
  for (const Vec3& point : snapshot.particles) add(point, snapshot.radius);
  for (const Vec3& point : snapshot.surface.points) add(point, 0);
  for (const SnapshotArrow& arrow : snapshot.arrows) add(arrow.from + arrow.along, 0);
  for (const SnapshotTrace& trace : snapshot.traces)
    for (const Vec3& point : trace.path) add(point, snapshot.radius);
  for (const SnapshotBone& bone : snapshot.bones)
    add(bone.head, snapshot.radius), add(bone.tail, snapshot.radius);
  for (const SnapshotForce& force : snapshot.forces) {
    add(force.from, 0);
    add(force.from + force.along, 0);
  }
  if (snapshot.obstacles.points.empty()) return;
  const Box reach = bounds(snapshot.obstacles.points).intersection(snapshot.obstacle_space);
  if (reach.isEmpty()) return;
  for (int corner = 0; corner < 8; ++corner)
    add(reach.corner(static_cast<Box::CornerType>(corner)), 0);
}

}  // namespace

Box seen(const Mat3& view, const Snapshot& snapshot) {
  Box box;
  for_each_point(snapshot, [&](const Vec3& point, double around) {
    const Vec3 p = view * point, reach = Vec3::Constant(around);
    box.extend(Box(p - reach, p + reach));
  });
  return box;
}

void Cylinder::extend(const Snapshot& snapshot) {
  for_each_point(snapshot, [&](const Vec3& point, double around) {
    const Vec3 from = point - axis;
    radius = std::max(radius, std::hypot(from.x(), from.y()) + around);
    low = std::min(low, from.z() - around);
    high = std::max(high, from.z() + around);
  });
}

void Cylinder::extend(const Cylinder& other) {
  const Vec3 from = other.axis - axis;
  radius = std::max(radius, std::hypot(from.x(), from.y()) + other.radius);
  low = std::min(low, from.z() + other.low);
  high = std::max(high, from.z() + other.high);
}

Camera orbiting(const Cylinder& cylinder, const Mat3& view, double angle) {
  Camera camera;
  camera.view = view * Eigen::AngleAxisd(-angle, Vec3::UnitZ()).toRotationMatrix();
  const Vec3 middle = camera.view * cylinder.axis;
  for (int row = 0; row < 3; ++row) {
    const Vec3 along = camera.view.row(row);
    const double across = cylinder.radius * std::hypot(along.x(), along.y());
    const auto [least, most] = std::minmax({cylinder.low * along.z(), cylinder.high * along.z()});
    camera.frame.min()[row] = middle[row] + least - across;
    camera.frame.max()[row] = middle[row] + most + across;
  }
  return camera;
}

double meters_per_pixel(const Box& frame, int width, int height) {
  if (frame.isEmpty()) return 1;
  const Vec3 size = frame.sizes();
  const double scale = std::max(size.x() / width, size.y() / height);
  return scale > 0 ? scale : 1;
}

}  // namespace sinew

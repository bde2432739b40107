// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/camera.h>

#include <algorithm>

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

Box seen(const Mat3& view, const Snapshot& snapshot) {
  Box box;
  const auto add = [&](const Vec3& point, double around) {
    if (!point.allFinite())
      throw bad_input("a position to draw is not finite", "draw earlier frames of the run");
    const Vec3 p = view * point, reach = Vec3::Constant(around);
    box.extend(Box(p - reach, p + reach));
  };
  for (const Vec3& point : snapshot.particles) add(point, snapshot.radius);
  for (const Vec3& point : snapshot.surface.points) add(point, 0);
  for (const SnapshotArrow& arrow : snapshot.arrows) add(arrow.from + arrow.along, 0);
  for (const SnapshotBone& bone : snapshot.bones)
    add(bone.head, snapshot.radius), add(bone.tail, snapshot.radius);
  if (snapshot.obstacles.points.empty()) return box;
  const Box reach = bounds(snapshot.obstacles.points).intersection(snapshot.obstacle_space);
  if (reach.isEmpty()) return box;
  for (int corner = 0; corner < 8; ++corner)
    add(reach.corner(static_cast<Box::CornerType>(corner)), 0);
  return box;
}

double meters_per_pixel(const Box& frame, int width, int height) {
  if (frame.isEmpty()) return 1;
  const Vec3 size = frame.sizes();
  const double scale = std::max(size.x() / width, size.y() / height);
  return scale > 0 ? scale : 1;
}

}  // namespace sinew

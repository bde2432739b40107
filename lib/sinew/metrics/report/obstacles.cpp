// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include <sinew/metrics/report/playback.h>

namespace sinew {
namespace {

/// The part of a convex polygon on one side of an axis-parallel plane (Sutherland and Hodgman):
/// where `sign` times the coordinate is at least `limit`.
Points beyond(const Points& polygon, int axis, double sign, double limit) {
  Points kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &here = polygon[i], &next = polygon[(i + 1) % polygon.size()];
    const double over = sign * here[axis] - limit, then = sign * next[axis] - limit;
    if (over >= 0) kept.push_back(here);
    if ((over < 0) != (then < 0)) kept.push_back(here + over / (over - then) * (next - here));
  }
  return kept;
}

}  // namespace

Points cut_to(const Box& space, const Triangles& surface) {
  Points corners;
  for (const auto& [a, b, c] : surface.faces) {
    Points polygon{surface.points[a], surface.points[b], surface.points[c]};
    for (int axis = 0; axis < 3; ++axis) {
      polygon = beyond(polygon, axis, 1, space.min()[axis]);
      polygon = beyond(polygon, axis, -1, -space.max()[axis]);
    }
    for (std::size_t i = 2; i < polygon.size(); ++i)
      corners.insert(corners.end(), {polygon[0], polygon[i - 1], polygon[i]});
  }
  return corners;
}

void add_obstacles(Playback& playback, std::size_t frame, const Box& space,
                   const Triangles& obstacles) {
  const auto found = std::find_if(playback.frames.begin(), playback.frames.end(),
                                  [&](const PlaybackFrame& one) { return one.frame == frame; });
  if (found == playback.frames.end()) return;
  for (const Vec3& corner : cut_to(space, obstacles))
    append_place(found->obstacles, corner, playback.origin);
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/snapshot.h>

#include <algorithm>
#include <cmath>

namespace sinew {

void shift(Snapshot& snapshot, const Vec3& by) {
  const auto move = [&](Points& points) {
    for (Vec3& point : points) point += by;
  };
  for (Points* points : {&snapshot.particles, &snapshot.surface.points, &snapshot.cut.points,
                         &snapshot.references, &snapshot.obstacles.points})
    move(*points);
  snapshot.cut.point += by;
  for (SnapshotBone& bone : snapshot.bones) bone.head += by, bone.tail += by;
  for (SnapshotArrow& arrow : snapshot.arrows) arrow.from += by;
  for (SnapshotForce& force : snapshot.forces) force.from += by;
  for (SnapshotLine& line : snapshot.lines) line.from += by, line.to += by;
  for (SnapshotCurve& curve : snapshot.curves) move(curve.points);
  for (SnapshotTrace& trace : snapshot.traces) move(trace.path);
}

Snapshot marked(const Snapshot& snapshot, Mark mark) {
  Snapshot some;
  some.radius = snapshot.radius;
  for (std::size_t i = 0; i < snapshot.particles.size(); ++i) {
    if ((snapshot.marks.empty() ? Mark::none : snapshot.marks[i]) != mark) continue;
    some.particles.push_back(snapshot.particles[i]);
    some.marks.push_back(mark);
  }
  return some;
}

double ColorScale::position(double value) const {
  if (std::isnan(value)) return value;
  if (!(high > low) || value < low) return 0;
  return std::min(1.0, (value - low) / (high - low));
}

Color ColorScale::color(double value) const {
  if (colors.empty() || std::isnan(value)) return mapped_color(position(value), map);
  const double last = static_cast<double>(colors.size()) - 1;
  return colors[static_cast<std::size_t>(std::lround(std::clamp(value, 0.0, last)))];
}

}  // namespace sinew

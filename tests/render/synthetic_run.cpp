// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic_run.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace sinew {
namespace {

constexpr double spacing = 0.0141421356237, radius = 0.01;
const Vec3 size(11 * spacing, 11 * spacing, 49 * spacing);

/// Rises from 0 at the near end of the joint to 1 at its far end.
double smooth_step(double z) {
  const double t = std::clamp((z - 0.3 * size.z()) / (0.4 * size.z()), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// The rigid frame of the cross-section at height z.
RigidFrame section(double z, double bend, double twist) {
  const auto turn = [&](double at) {
    return Mat3(Eigen::AngleAxisd(bend * smooth_step(at), Vec3::UnitY()));
  };
  RigidFrame frame;
  constexpr int pieces = 200;
  for (int i = 0; i < pieces; ++i) frame.origin += z / pieces * turn(z * (i + 0.5) / pieces).col(2);
  frame.rotation = turn(z) * Eigen::AngleAxisd(twist * smooth_step(z), Vec3::UnitZ());
  return frame;
}

Vec3 deformed(const Vec3& p, double bend, double twist) {
  const RigidFrame frame = section(p.z(), bend, twist);
  return frame.origin + frame.rotation * Vec3(p.x(), p.y(), 0);
}

Points lattice() {
  Points points;
  for (int k = 0; k < 49; ++k)
    for (int j = 0; j < 11; ++j)
      for (int i = 0; i < 11; ++i)
        if ((i + j + k) % 2 == 0) points.push_back(spacing * Vec3(i - 5, j - 5, k + 0.5));
  return points;
}

/// The cells of a box's six sides, points shared.
class BoxMesh {
 public:
  BoxMesh() {
    for (int axis = 0; axis < 3; ++axis)
      for (int end : {0, cells_[axis]}) add_side(axis, end);
  }
  Triangles surface;

 private:
  using Site = std::array<int, 3>;

  void add_side(int axis, int end) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (int i = 0; i < cells_[u]; ++i)
      for (int k = 0; k < cells_[v]; ++k) {
        const auto corner = [&](int a, int b) {
          Site site;
          site[axis] = end, site[u] = i + a, site[v] = k + b;
          return point(site);
        };
        std::array<int, 4> quad{corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
        if (end == 0) std::reverse(quad.begin(), quad.end());
        surface.faces.push_back({quad[0], quad[1], quad[2]});
        surface.faces.push_back({quad[0], quad[2], quad[3]});
      }
  }

  int point(const Site& site) {
    const auto [place, added] = known_.try_emplace(site, surface.points.size());
    if (added)
      surface.points.push_back(
          size.cwiseProduct(Vec3(site[0] / 8.0 - 0.5, site[1] / 10.0 - 0.5, site[2] / 25.0)));
    return place->second;
  }

  const Site cells_{8, 10, 25};
  std::map<Site, int> known_;
};

SnapshotBone bone(double from, double length, double bend, double twist) {
  const RigidFrame start = section(from, bend, twist);
  SnapshotBone bone;
  bone.head = start.origin;
  bone.axes << start.rotation.col(2), start.rotation.col(0), start.rotation.col(1);
  bone.tail = bone.head + length * bone.axes.col(0);
  return bone;
}

}  // namespace

Snapshot synthetic_snapshot(double bend, double twist) {
  Snapshot snapshot;
  snapshot.radius = radius;
  for (const Vec3& p : lattice()) {
    snapshot.particles.push_back(deformed(p, bend, twist));
    snapshot.values.push_back((snapshot.particles.back() - p).norm());
  }
  snapshot.surface = BoxMesh().surface;
  for (Vec3& p : snapshot.surface.points) p = deformed(p, bend, twist);
  snapshot.bones = {bone(0.02, size.z() / 2 - 0.02, 0, 0),
                    bone(size.z() * 0.7, size.z() * 0.28, bend, twist)};
  return snapshot;
}

ColorScale synthetic_scale() { return {"displacement", "m", 0, 0.5}; }

}  // namespace sinew

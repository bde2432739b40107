// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic_run.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <sinew/scene/rig.h>

namespace sinew {
namespace {

const Vec3 size(0.12, 0.12, 0.48);  // m
constexpr double joint = 0.24;      // m, where the second bone begins
constexpr double blend = 0.06;      // m, half the height over which the body follows both bones

Points lattice() {
  Points points;
  const double step = std::sqrt(2.0) * SyntheticRun::radius;
  const Eigen::Vector3i last = (size / step).cast<int>();
  for (int k = 0; k <= last.z(); ++k)
    for (int j = 0; j <= last.y(); ++j)
      for (int i = 0; i <= last.x(); ++i)
        if ((i + j + k) % 2 == 0)
          points.push_back(Vec3(i - last.x() / 2.0, j - last.y() / 2.0, k) * step);
  return points;
}

/// A box of n x n x m quads, each cut in two; points shared between sides.
Triangles box(int n, int m) {
  Triangles skin;
  std::map<std::array<int, 3>, int> index;
  const Eigen::Array3i cells(n, n, m);
  const auto point = [&](const Eigen::Array3i& at) {
    const auto [entry, fresh] =
        index.try_emplace({at[0], at[1], at[2]}, static_cast<int>(skin.points.size()));
    if (fresh)
      skin.points.push_back(
          (at.cast<double>() / cells.cast<double>() - Eigen::Array3d(0.5, 0.5, 0)) * size.array());
    return entry->second;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      const int p = (axis + 1) % 3, q = (axis + 2) % 3;
      for (int i = 0; i < cells[p]; ++i)
        for (int j = 0; j < cells[q]; ++j) {
          std::array<int, 4> corner;
          for (int c = 0; c < 4; ++c) {
            Eigen::Array3i at;
            at[axis] = side * cells[axis];
            at[p] = i + (c == 1 || c == 2);
            at[q] = j + (c >= 2);
            corner[c] = point(at);
          }
          if (side == 0) std::swap(corner[1], corner[3]);
          skin.faces.push_back({corner[0], corner[1], corner[2]});
          skin.faces.push_back({corner[0], corner[2], corner[3]});
        }
    }
  return skin;
}

Settings settings() {
  Settings scene;
  scene.bones = {{"lower", "", Vec3(0, 0, 0), Vec3(0, 0, joint)},
                 {"upper", "lower", std::nullopt, Vec3(0, 0, size.z())}};
  const auto key = [](double time, double angle) {
    KeyDefinition made;
    made.time = time;
    made.axis = Vec3(0, 1, 0);
    made.angle = angle;
    made.twist = angle / 3;
    return made;
  };
  TrackDefinition track;
  track.bone = "upper";
  track.keys = {key(0, 0), key(SyntheticRun::half_turn, 90)};
  scene.tracks = {track};
  return scene;
}

double weight_of_upper(const Vec3& rest) {
  return std::clamp((rest.z() - joint + blend) / (2 * blend), 0.0, 1.0);
}

std::vector<std::int32_t> nearest_bones(const Points& points) {
  std::vector<std::int32_t> bones;
  for (const Vec3& point : points) bones.push_back(point.z() < joint ? 0 : 1);
  return bones;
}

/// Where `rest` is when the two bones carry it in proportion to its weight.
Vec3 blended(const Vec3& rest, const Skeleton& skeleton, const Pose& pose) {
  const Vec3 lower = carried(rest, skeleton.bones[0].rest, pose[0].frame);
  const Vec3 upper = carried(rest, skeleton.bones[1].rest, pose[1].frame);
  return lower + weight_of_upper(rest) * (upper - lower);
}

}  // namespace

SyntheticRun::SyntheticRun()
    : rest(lattice()),
      bone(nearest_bones(rest)),
      skin(box(8, 24)),
      skin_bone(nearest_bones(skin.points)),
      skeleton(skeleton_of(settings())),
      motion(motion_of(settings(), skeleton)) {}

Dataset SyntheticRun::particles(Moment moment) const {
  const Pose pose = pose_at(skeleton, motion, moment.time);
  const std::size_t n = count();
  Particles now = particles_at(rest, radius, 0.001);
  Points pair(n), damping(n), pull(n), world(n, Vec3(0, 1e-4, 0));
  std::vector<std::int32_t> neighbors(n);
  // The physics may keep its particles in any order; here it is backwards.
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t w = n - 1 - i;
    now.id[i] = static_cast<std::int32_t>(w);
    now.set_position(i, blended(rest[w], skeleton, pose));
    now.set_velocity(i, pose[bone[w]].velocity_at(now.position(i)));
    pair[i] = 0.1 * (rest[w] - now.position(i));
    damping[i] = -0.01 * now.velocity(i);
    pull[i] = Vec3(0, 0, 1e-3 * bone[w]);
    neighbors[i] = static_cast<std::int32_t>(w % 13);
  }
  const Energies energies{moment.time, 2, 3, 4, 5, 6};
  const std::vector<std::int32_t> material(n, 0), broken(n, 1), group(n, -1), level(n, 0),
      limited(n, 0);
  const Binding binding = one_bone_each(bone);
  return evaluated(particles_dataset({now,
                                      rest,
                                      binding,
                                      pair,
                                      damping,
                                      pull,
                                      neighbors,
                                      energies,
                                      world,
                                      material,
                                      broken,
                                      {},
                                      group,
                                      level,
                                      {},
                                      limited,
                                      {0, 0}},
                                     positions_by_id(now), moment));
}

Binding one_bone_each(const std::vector<std::int32_t>& bones, double weight) {
  Binding binding;
  binding.first = {0};
  for (const std::int32_t bone : bones) {
    binding.influences.push_back({.bone = bone, .weight = weight});
    binding.first.push_back(static_cast<std::uint32_t>(binding.influences.size()));
  }
  return binding;
}

Dataset SyntheticRun::surface(Moment moment) const {
  const Pose pose = pose_at(skeleton, motion, moment.time);
  Triangles now = skin;
  for (Vec3& point : now.points) point = blended(point, skeleton, pose);
  return surface_dataset(now, skin.points, skin_bone, moment);
}

Dataset SyntheticRun::bones(Moment moment) const {
  return bones_dataset(skeleton, pose_at(skeleton, motion, moment.time), moment);
}

Dataset SyntheticRun::frames(Moment moment) const {
  const Points force = {Vec3(0, 0, -1), Vec3(0, 0, 1)};
  const Points turning = {Vec3(0, -2, 0), Vec3(0, 2, 0)};
  return frames_dataset(skeleton, pose_at(skeleton, motion, moment.time), {force, turning}, moment);
}

Dataset SyntheticRun::obstacles(Moment moment) const {
  const Triangles floor = {{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}},
                           {{0, 1, 2}, {0, 2, 3}}};
  const Vec3 up = moment.time * Vec3::UnitZ();
  const std::vector<ObstacleFrame> all = {
      {floor, {}, {0, 0, 0}, {0, 0, 0}, {0, 0, -1}, {0, 0, 0}},
      {floor, {up, Mat3::Identity()}, {0, 0, 1}, {0, 0, 2}, {0, 0, -2}, {0, 3, 0}}};
  return obstacles_dataset(all, moment);
}

BodyFile SyntheticRun::body() const {
  BodyFile body;
  body.particles = particles_at(rest, radius, 0.001);
  body.neighbors.assign(count(), 12);
  body.component.assign(count(), 0);
  body.bone = bone;
  body.volume_share.emplace(count(), 1.0);
  body.weight.emplace(count(), 1.0);
  body.meta = "{\"packing\": \"fcc\"}";
  return body;
}

}  // namespace sinew

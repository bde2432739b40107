// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/rig/skinning.h>

#include <algorithm>
#include <numeric>

#include <sinew/core/cell_grid.h>
#include <sinew/core/parallel.h>

namespace sinew {

namespace {

constexpr std::size_t nearest_vertices = 8, max_bones = 4;
constexpr std::size_t points_per_piece = 512;

struct NearVertex {
  double distance;
  std::uint32_t vertex;
  bool operator<(const NearVertex& other) const {
    return distance != other.distance ? distance < other.distance : vertex < other.vertex;
  }
};

/// The nearest vertices closer than `range`; empty where there are not enough.
std::vector<NearVertex> nearest_within(const CellGrid& grid, const Points& vertices,
                                       const Vec3& point, double range) {
  std::vector<NearVertex> near;
  grid.for_each_near(point, [&](std::uint32_t j) {
    const double distance = (vertices[j] - point).norm();
    if (distance < range) near.push_back({distance, j});
  });
  const std::size_t wanted = std::min(nearest_vertices, vertices.size());
  if (near.size() < wanted) return {};
  std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(wanted), near.end());
  near.resize(wanted);
  return near;
}

/// Finds vertices near each point; the search is repeated twice as far for those with too few.
std::vector<std::vector<NearVertex>> nearest_of(const Points& vertices, const Points& points) {
  std::vector<std::vector<NearVertex>> near(points.size());
  Box box;
  for (const Vec3& vertex : vertices) box.extend(vertex);
  for (const Vec3& point : points) box.extend(point);
  std::vector<std::uint32_t> left(points.size());
  std::iota(left.begin(), left.end(), 0);
  for (double range = box.diagonal().norm() / 64 + 1e-300; !left.empty(); range *= 2) {
    const CellGrid grid(vertices, range);
    parallel_for(left.size(), points_per_piece, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k)
        near[left[k]] = nearest_within(grid, vertices, points[left[k]], range);
    });
    std::erase_if(left, [&](std::uint32_t i) { return !near[i].empty(); });
  }
  return near;
}

bool heavier(const BoneWeight& a, const BoneWeight& b) {
  return a.weight != b.weight ? a.weight > b.weight : a.bone < b.bone;
}

void add(double weight, int bone, std::vector<BoneWeight>& mean) {
  for (BoneWeight& one : mean)
    if (one.bone == bone) {
      one.weight += weight;
      return;
    }
  mean.push_back({bone, weight});
}

std::vector<BoneWeight> mean_of(const std::vector<NearVertex>& near, const BoneWeights& weights,
                                const std::vector<std::uint32_t>& vertex, double least) {
  std::vector<BoneWeight> mean;
  for (const NearVertex& one : near)
    for (const BoneWeight& part : weights.of(vertex[one.vertex]))
      add(part.weight / std::max(one.distance, least), part.bone, mean);
  std::sort(mean.begin(), mean.end(), heavier);
  if (mean.size() > max_bones) mean.resize(max_bones);
  double sum = 0;
  for (const BoneWeight& one : mean) sum += one.weight;
  for (BoneWeight& one : mean) one.weight /= sum;
  return mean;
}

}  // namespace

BoneWeights weights_of(const Binding& binding) {
  BoneWeights weights;
  weights.first = binding.first;
  for (const Influence& one : binding.influences) weights.weights.push_back({one.bone, one.weight});
  return weights;
}

BoneWeights carried_weights(const Points& vertices, const BoneWeights& weights,
                            const Points& points) {
  std::vector<std::uint32_t> weighted;  // vertices
  Points places;
  Box box;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (weights.of(i).empty()) continue;
    weighted.push_back(static_cast<std::uint32_t>(i));
    places.push_back(vertices[i]);
    box.extend(vertices[i]);
  }
  BoneWeights carried;
  carried.first.assign(points.size() + 1, 0);
  if (weighted.empty()) return carried;
  // A point this close to a vertex has that vertex's weights.
  const double least = 1e-9 * box.diagonal().norm() + 1e-300;
  const auto near = nearest_of(places, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (const BoneWeight& one : mean_of(near[i], weights, weighted, least))
      carried.weights.push_back(one);
    carried.first[i + 1] = static_cast<std::uint32_t>(carried.weights.size());
  }
  return carried;
}

namespace {

constexpr std::size_t blends_per_task = 1024;

using BonesOfPoint = std::span<const BoneWeight>;

template <class Move>
Points each_moved(const Points& rest, const BoneWeights& weights, const Move& move) {
  Points moved = rest;
  parallel_for(rest.size(), blends_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (!weights.of(i).empty()) moved[i] = move(rest[i], weights.of(i));
  });
  return moved;
}

/// A rigid motion: rotation `real`, then a shift; dual = shift real / 2.
struct DualQuaternion {
  Quat real, dual;
};

DualQuaternion motion_of(const Bone& bone, const BonePose& pose) {
  const Quat turn(pose.turn);
  const Vec3 shift = pose.frame.origin - pose.turn * bone.head();
  Quat dual = Quat(0, shift.x(), shift.y(), shift.z()) * turn;
  dual.coeffs() *= 0.5;
  return {turn, dual};
}

DualQuaternion blended(const std::vector<DualQuaternion>& motions, BonesOfPoint parts) {
  DualQuaternion sum{Quat(0, 0, 0, 0), Quat(0, 0, 0, 0)};
  const Quat& heaviest = motions[parts.front().bone].real;
  for (const BoneWeight& part : parts) {
    const DualQuaternion& motion = motions[part.bone];
    const double weight = heaviest.dot(motion.real) < 0 ? -part.weight : part.weight;
    sum.real.coeffs() += weight * motion.real.coeffs();
    sum.dual.coeffs() += weight * motion.dual.coeffs();
  }
  const double length = sum.real.norm();
  sum.real.coeffs() /= length;
  sum.dual.coeffs() /= length;
  return sum;
}

Vec3 moved_by(const DualQuaternion& motion, const Vec3& point) {
  const Quat shift = motion.dual * motion.real.conjugate();
  return motion.real * point + 2 * shift.vec();
}

Vec3 stretched(const Vec3& point, BonesOfPoint parts, const Skeleton& skeleton, const Pose& pose) {
  Vec3 longer = point;
  for (const BoneWeight& part : parts) {
    if (pose[part.bone].stretch == 1) continue;
    const Bone& bone = skeleton.bones[part.bone];
    const double along = bone.axis().dot(point - bone.head());
    longer += part.weight * (pose[part.bone].stretch - 1) * along * bone.axis();
  }
  return longer;
}

}  // namespace

Points linear_blend_skinned(const Points& rest, const BoneWeights& weights,
                            const Skeleton& skeleton, const Pose& pose) {
  return each_moved(rest, weights, [&](const Vec3& point, BonesOfPoint parts) {
    Vec3 sum = Vec3::Zero();
    for (const BoneWeight& part : parts)
      sum += part.weight * pose[part.bone].carried(point, skeleton.bones[part.bone]);
    return sum;
  });
}

Points dual_quaternion_skinned(const Points& rest, const BoneWeights& weights,
                               const Skeleton& skeleton, const Pose& pose) {
  std::vector<DualQuaternion> motions;
  for (std::size_t b = 0; b < pose.size(); ++b)
    motions.push_back(motion_of(skeleton.bones[b], pose[b]));
  return each_moved(rest, weights, [&](const Vec3& point, BonesOfPoint parts) -> Vec3 {
    return moved_by(blended(motions, parts), stretched(point, parts, skeleton, pose));
  });
}

}  // namespace sinew

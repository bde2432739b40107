// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/intrusions.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <sinew/core/cell_grid.h>
#include <sinew/core/parallel.h>
#include <sinew/core/particles.h>
#include <sinew/core/text.h>
#include <sinew/rig/skinning.h>

namespace sinew {
namespace {

using Particle = std::uint32_t;
using Pair = std::array<int, 2>;

constexpr std::size_t particles_per_task = 512;
constexpr double min_depth = 0.5;      // radii: rows of a lattice do not lie closer
constexpr double apart_at_rest = 3.9;  // radii: 1.5 ranges of the attraction
constexpr std::size_t max_outer = 60'000;

Pair pair_of(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

/// Particles at the body's surface.
std::vector<Particle> outer_of(const Body& body, const NeighborLists& lists) {
  std::vector<Particle> outer;
  for (Particle i = 0; i < body.rest.size(); ++i)
    if (lists.of(i).size() < max_neighbors_at_rest) outer.push_back(i);
  return outer;
}

/// How far each particle is from one at the surface, m; by the ways between neighbors, along which
/// the nearest one is passed on.
std::vector<double> depths_at_rest(const Body& body, const NeighborLists& lists,
                                   const std::vector<Particle>& outer) {
  std::vector<double> depth(body.rest.size(), std::numeric_limits<double>::infinity());
  std::vector<Particle> nearest(body.rest.size()), reached = outer;
  for (const Particle i : outer) depth[i] = 0, nearest[i] = i;
  for (std::size_t k = 0; k < reached.size(); ++k)
    for (const Particle next : lists.of(reached[k])) {
      const Particle from = nearest[reached[k]];
      const double distance = (body.rest[next] - body.rest[from]).norm();
      if (std::isinf(depth[next])) reached.push_back(next);
      if (distance < depth[next]) depth[next] = distance, nearest[next] = from;
    }
  for (double& one : depth)
    if (std::isinf(one)) one = 0;  // a body without a surface
  return depth;
}

/// Where two bones hold particles that touch at rest.
struct Joint {
  Vec3 center = Vec3::Zero();
  double radius = 0;  ///< radius of what folds with it, m
};

class Joints {
 public:
  Joints(const Body& body, const NeighborLists& lists) {
    std::map<Pair, std::vector<Particle>> touching;
    for (Particle i = 0; i < body.rest.size(); ++i)
      for (const Particle j : lists.of(i)) {
        const int a = body.binding.bone(i), b = body.binding.bone(j);
        if (a != b && a != no_bone && b != no_bone) touching[pair_of(a, b)].push_back(i);
      }
    for (const auto& [bones, particles] : touching) {
      Joint& joint = joints_[bones];
      for (const Particle i : particles)
        joint.center += body.rest[i] / static_cast<double>(particles.size());
      for (const Particle i : particles)
        joint.radius = std::max(joint.radius, (body.rest[i] - joint.center).norm());
      const auto& sections = body.binding.cross_section;
      joint.radius += std::sqrt(std::max(sections[static_cast<std::size_t>(bones[0])],
                                         sections[static_cast<std::size_t>(bones[1])]));
    }
  }

  /// nullptr where two bones have none.
  const Joint* of(int a, int b) const {
    const auto found = joints_.find(pair_of(a, b));
    return found == joints_.end() ? nullptr : &found->second;
  }

 private:
  std::map<Pair, Joint> joints_;
};

using Depths = std::map<Pair, double>;

void put(const Pair& bones, double depth, Depths& all) {
  double& most = all[bones];
  most = std::max(most, depth);
}

/// Finds overlaps at one moment after another.
class Overlaps {
 public:
  explicit Overlaps(const Body& body)
      : body_(body),
        near_(neighbors_of(body)),
        outer_(outer_of(body, near_->nearest)),
        depth_(depths_at_rest(body, near_->nearest, outer_)),
        joints_(body, near_->nearest) {
    const std::size_t stride = 1 + outer_.size() / max_outer;
    std::size_t kept = 0;
    for (std::size_t k = 0; k < outer_.size(); k += stride) outer_[kept++] = outer_[k];
    outer_.resize(kept);
    bone_.reserve(body.rest.size());
    for (std::size_t i = 0; i < body.rest.size(); ++i) bone_.push_back(body.binding.bone(i));
  }

  /// Depth of each pair of bones, m, with the particles at `now` (m, by id).
  Depths at(const Points& now) const {
    const CellGrid grid(now, reach());
    std::vector<Depths> parts(outer_.size() / particles_per_task + 1);
    parallel_for(outer_.size(), particles_per_task, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k)
        add(outer_[k], now, grid, parts[begin / particles_per_task]);
    });
    Depths all;
    for (const Depths& part : parts)
      for (const auto& [bones, depth] : part) put(bones, depth, all);
    return all;
  }

  /// The particles of a pair of bones that overlap.
  std::vector<Particle> of(const Pair& bones, const Points& now) const {
    const CellGrid grid(now, reach());
    std::vector<Particle> all;
    for (const Particle i : outer_)
      for_each_overlap(i, now, grid, [&](Particle j, double) {
        if (pair_of(bone_[i], bone_[j]) == bones) all.push_back(i), all.push_back(j);
      });
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  }

 private:
  double reach() const { return 2 * body_.material.pair.r; }

  void add(Particle i, const Points& now, const CellGrid& grid, Depths& all) const {
    for_each_overlap(i, now, grid, [&](Particle j, double depth) {
      put(pair_of(bone_[i], bone_[j]), depth, all);
    });
  }

  template <class Use>
  void for_each_overlap(Particle i, const Points& now, const CellGrid& grid, const Use& use) const {
    if (bone_[i] == no_bone) return;
    grid.for_each_near(now[i], [&](Particle j) {
      if (bone_[j] == bone_[i] || bone_[j] == no_bone) return;
      const double distance = (now[i] - now[j]).norm();
      if (distance < reach() && meet(i, j)) use(j, reach() - distance + depth_[j]);
    });
  }

  /// Whether an overlap of the two counts.
  bool meet(Particle i, Particle j) const {
    const Vec3 &a = body_.rest[i], &b = body_.rest[j];
    if ((a - b).norm() < apart_at_rest * body_.material.pair.r) return false;
    const Joint* joint = joints_.of(bone_[i], bone_[j]);
    return joint == nullptr || ((a - joint->center).norm() > joint->radius &&
                                (b - joint->center).norm() > joint->radius);
  }

  const Body& body_;
  SharedNeighbors near_;
  std::vector<Particle> outer_;
  std::vector<double> depth_;
  Joints joints_;
  std::vector<int> bone_;
};

}  // namespace

Points skinned(const Body& body, const Pose& pose) {
  return dual_quaternion_skinned(body.rest, weights_of(body.binding), body.skeleton, pose);
}

std::vector<Intrusion> intrusions(const Body& body, const Motion& motion,
                                  std::span<const double> times) {
  if (motion.tracks.empty() || body.rest.empty()) return {};
  const Overlaps overlaps(body);
  const BoneWeights weights = weights_of(body.binding);
  const double least = min_depth * body.material.pair.r;
  PoseCursor poses(body.skeleton, motion);
  std::map<Pair, Intrusion> found;
  for (const double time : times) {
    const Points now = dual_quaternion_skinned(body.rest, weights, body.skeleton, poses.at(time));
    for (const auto& [bones, depth] : overlaps.at(now)) {
      if (depth < least) continue;
      const auto [one, is_new] = found.try_emplace(bones, Intrusion{bones, 0, time, time});
      if (depth > one->second.depth) one->second.depth = depth, one->second.deepest = time;
    }
  }
  std::vector<Intrusion> all;
  all.reserve(found.size());
  for (const auto& [bones, one] : found) all.push_back(one);
  std::stable_sort(all.begin(), all.end(),
                   [](const Intrusion& a, const Intrusion& b) { return a.depth > b.depth; });
  return all;
}

std::vector<std::uint32_t> overlapping(const Body& body, const Pose& pose,
                                       const std::array<int, 2>& bones) {
  return Overlaps(body).of(bones, skinned(body, pose));
}

std::string intrusions_text(std::span<const Intrusion> found, const Body& body) {
  constexpr std::size_t named = 4;
  std::string text;
  for (std::size_t k = 0; k < std::min(named, found.size()); ++k) {
    const auto name = [&](int bone) {
      return shown(body.skeleton.bones[static_cast<std::size_t>(bone)].name);
    };
    text += (k > 0 ? ", " : "") + name(found[k].bones[0]) + " and " + name(found[k].bones[1]);
    if (found[k].depth > 0)
      text += " (" + three_digits(found[k].depth / body.material.pair.r) + " r)";
  }
  if (found.size() > named) text += ", and " + std::to_string(found.size() - named) + " more pairs";
  return text;
}

}  // namespace sinew

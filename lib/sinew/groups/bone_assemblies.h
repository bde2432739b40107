// SPDX-License-Identifier: GPL-3.0-or-later
// Assemblies: bones of a skeleton that are stiff to each other, and which of them particles follow.
//
//     const BoneAssemblies assemblies(body, moves, joint_distance);
//     const int assembly = assemblies.of(i);
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <sinew/rig/motion.h>

namespace sinew {

struct Body;

/// Between two moments, s.
struct TimeSpan {
  double begin, end;
};

/// For each bone, whether it turns, shifts or stretches relative to its parent in the span,
/// from where it was in `before`. Looks at so many moments.
std::vector<bool> moving_joints(const Skeleton& skeleton, const Motion& motion, const Pose& before,
                                TimeSpan span, int moments);

class BoneAssemblies {
 public:
  /// `moves`: of each bone, its joint with its parent. `joint_distance`: nearer than this to a
  /// joint that moves, particles follow none: along the bone, in square roots of the
  /// cross-section of the bone whose head the joint is. `kept_free`: by particle, 1 follows
  /// none; empty: all do.
  BoneAssemblies(const Body& body, const std::vector<bool>& moves, double joint_distance,
                 std::span<const std::uint8_t> kept_free = {});

  static constexpr int none = -1, without_bones = -2;

  /// The assembly that particle i follows, or one of these: none for what pins, supports, loads or
  /// muscles act on, and what is bound to several assemblies.
  int of(std::size_t i) const;

 private:
  struct Joint {
    Vec3 place;
    double distance, reach;
  };

  const Body& body_;
  std::vector<int> assembly_;
  std::vector<std::uint8_t> acted_;
  std::vector<Joint> joints_;
};

}  // namespace sinew

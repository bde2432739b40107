// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of a skeleton whose bones are stiff to each other, and which of them particles follow.
//
//     const BoneParts parts(body, moves, joint_distance);
//     const int part = parts.of(i);
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

class BoneParts {
 public:
  /// `moves`: of each bone, its joint with its parent. `joint_distance`: nearer than this to a
  /// joint that moves, particles follow no part: along the bone, in square roots of the
  /// cross-section of the bone whose head the joint is. `kept_free`: by particle, 1 follows no
  /// part; empty: all do.
  BoneParts(const Body& body, const std::vector<bool>& moves, double joint_distance,
            std::span<const std::uint8_t> kept_free = {});

  static constexpr int none = -1, without_bones = -2;

  /// The part that particle i follows, or one of these: none for what pins, supports, loads or
  /// muscles act on, and what several parts hold.
  int of(std::size_t i) const;

 private:
  struct Joint {
    Vec3 place;
    double distance, reach;
  };

  const Body& body_;
  std::vector<int> part_;
  std::vector<std::uint8_t> acted_;
  std::vector<Joint> joints_;
};

}  // namespace sinew

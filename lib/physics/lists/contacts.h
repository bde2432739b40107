// SPDX-License-Identifier: GPL-3.0-or-later
// How far the motions of rigid frames alone have brought particles towards each other since the
// lists were built. Particles are grouped by the frame that carries them; x(t) = T (x(0) + s) + e,
// with T the frame's motion, and s and e known in length. Two particles of one frame approach by
// 2 |e| at most; two of frames A and B by |(T_A - T_B) x| more, which is largest at a corner of a
// box around the particles meant, and less what they were farther apart than the lists' range.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vector.h"
#include "physics/lists/block_state.h"
#include "rig/pose.h"

namespace sinew {

/// The motion since a pose of reference: x -> turn x + shift.
struct RigidMotion {
  Mat3 turn = Mat3::Identity();
  Vec3 shift = Vec3::Zero();
};

/// Of each frame from `before` to `now`, and of the scene, which stands still, as the last.
std::vector<RigidMotion> motions_between(const Pose& before, const Pose& now);

class Contacts {
 public:
  Contacts() = default;
  /// `carrier` names the group of each particle, below `groups`. Lists hold the pairs within
  /// `range` (m).
  template <class Real>
  Contacts(const BlockState<Real>& state, const Measure& measure,
           std::span<const std::uint32_t> carrier, std::size_t groups, double range);

  /// How much nearer the frames' motions since the reference may have brought particles that the
  /// lists do not pair, m, when no particle is farther than `shift` (m) out of its place. The lists
  /// hold as long as this plus 2 |e| stays below range - b.
  double approach(std::span<const RigidMotion> motions, double shift = 0) const;
  /// The same for pairs that the lists hold, and only what was added after `earlier`, when no
  /// particle was farther than `moved` (m) from its T x(0).
  double approach_since(std::span<const RigidMotion> earlier, std::span<const RigidMotion> motions,
                        double moved, double shift = 0) const;
  /// Upper bound of a group's distance from `point` at the reference, m; 0 for an empty group.
  double reach_from(const Vec3& point, std::size_t group) const;

 private:
  struct Pair {
    std::size_t a, b;
    Box near_a, near_b;  ///< the particles of either within reach of the other's; empty: none
    double gap;          ///< at least so far from each other, m
  };

  bool apart(const Pair& pair, std::span<const Vec3> centres, double shift) const;
  double approach_near(const Pair& pair, std::span<const RigidMotion> motions, double shift,
                       double most) const;
  double approach_far(const Pair& pair, std::span<const RigidMotion> motions, double shift,
                      double most) const;

  double range_ = 0;
  double reach_ = 0;                      ///< near_a and near_b hold all pairs closer than this, m
  std::vector<Box> whole_;                ///< by group
  std::vector<double> radius_;            ///< of spheres around them, m
  std::vector<std::vector<Box>> slices_;  ///< of each group, across its longest side
  std::vector<Pair> pairs_;
};

}  // namespace sinew

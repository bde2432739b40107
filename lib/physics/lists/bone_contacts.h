// SPDX-License-Identifier: GPL-3.0-or-later
// How far the motions of the bones alone have brought particles towards each other since the lists
// were built. Particles are grouped by the bone that leads them; x(t) = T x(0) + e, with T the
// bone's motion and |e| known. Two particles of one bone approach by 2 |e| at most; two of bones A
// and B by |(T_A - T_B) x| more, which is largest at a corner of a box around the particles meant.
#pragma once

#include <span>
#include <vector>

#include "core/vector.h"
#include "physics/lists/block_cells.h"
#include "rig/pose.h"

namespace sinew {

/// The motion since a pose of reference: x -> turn x + shift.
struct RigidMotion {
  Mat3 turn = Mat3::Identity();
  Vec3 shift = Vec3::Zero();
};

/// Of each bone from `before` to `now`, and of the scene, which stands still, as the last.
std::vector<RigidMotion> motions_between(const Pose& before, const Pose& now);

class BoneContacts {
 public:
  BoneContacts() = default;
  /// `lead` names the group of each particle of the cells, below `groups`; `origin` and `scale`
  /// turn their lengths into the scene's, m. Lists hold the pairs within `range` (m).
  BoneContacts(const BlockCells& cells, std::span<const std::uint32_t> lead, std::size_t groups,
               const Vec3& origin, double scale, double range);

  /// How much nearer the bones' motions since the reference may have brought particles that the
  /// lists do not pair, m, when no particle is farther than `shift` (m) out of its place. The lists
  /// hold as long as this plus 2 |e| stays below range - b.
  double approach(std::span<const RigidMotion> motions, double shift = 0) const;
  /// The same for pairs that the lists hold, and only what was added after `earlier`, when no
  /// particle was farther than `moved` (m) from its T x(0).
  double approach_since(std::span<const RigidMotion> earlier, std::span<const RigidMotion> motions,
                        double moved, double shift = 0) const;
  /// How far any particle has been carried, m.
  double travel(std::span<const RigidMotion> motions) const;
  /// Upper bound of a group's distance from `point` at the reference, m; 0 for an empty group.
  double reach_from(const Vec3& point, std::size_t group) const;

 private:
  struct Pair {
    std::size_t a, b;
    Box near_a, near_b;  ///< the particles of either within reach of the other's
  };
  struct Apart {
    std::size_t a, b;
    double gap;  ///< at least that far from each other, m
  };

  void find_pairs(const BlockCells& cells, std::span<const std::uint32_t> lead, const Vec3& origin,
                  double scale);

  double range_ = 0;
  double reach_ = 0;        ///< pairs of near_a and near_b are all pairs closer than this, m
  std::vector<Box> whole_;  ///< by group
  std::vector<Pair> pairs_;
  std::vector<Apart> apart_;
};

}  // namespace sinew

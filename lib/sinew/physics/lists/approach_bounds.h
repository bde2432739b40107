// SPDX-License-Identifier: GPL-3.0-or-later
// Bounds on how far particles have approached each other since a neighbor list was built.
//
// A list of the pairs within b + skin is valid while no two particles have approached by more than
// the skin. The displacement of each particle relative to its co-moving frame is bounded step by
// step by the fastest particle; when that bound has used up the skin, it is replaced by the
// measured displacements.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include <sinew/core/vector.h>
#include <sinew/physics/lists/block_state.h>
#include <sinew/rig/pose.h>

namespace sinew {

class Drift {
 public:
  Drift() = default;
  explicit Drift(double skin) : skin_(skin) {}

  /// Adds a step in which no particle moved more than `length` (m) relative to its co-moving frame.
  void add(double length) { moved_ += length; }
  /// Replaces the bound by a measured one: no particle is farther than this from its reference (m).
  void reset(double length) { moved_ = length; }

  double moved() const { return moved_; }
  /// Whether the list is still valid when the motion of the co-moving frames alone has brought
  /// particles nearer by this (m). A small part of the skin is reserved for rounding (of floats at
  /// most).
  bool holds(double approach) const { return 2 * moved_ + approach < skin_ * (1 - 1e-5); }
  double skin() const { return skin_; }

 private:
  double skin_ = 0, moved_ = 0;
};

/// How much farther than its velocity predicts a frame has moved particles within `reach` (m) of
/// its head in a step from `before` to `now`, m.
double excess_of_step(const BonePose& before, const BonePose& now, double step, double reach);

// Where the particles of different groups are close to each other.

class GroupCells {
 public:
  /// The particles of one group in one cell.
  struct Part {
    std::uint32_t group;
    std::int64_t next;  ///< of the same cell, or -1
    Box box;            ///< m
  };

  /// Cells whose edge is `reach` (m) or more.
  template <class Real>
  GroupCells(const BlockState<Real>& state, const Units& units,
             std::span<const std::uint32_t> group, double reach);

  const std::vector<Part>& parts() const { return parts_; }

  struct Meeting {
    Box near_a, near_b;  ///< around the particles of either group within reach of the other's, m
    double gap;          ///< lower bound of their distance, m
  };
  using Pair = std::pair<std::size_t, std::size_t>;  ///< the lower group first
  /// Of all groups that come within reach of each other.
  std::map<Pair, Meeting> meetings() const;

 private:
  void size_cells(const Box& box, std::size_t particles);
  std::size_t cell_of(const Vec3& p) const;
  void add(std::size_t cell, std::uint32_t group, const Vec3& p);
  void meet(const Part& one, const Part& other, std::map<Pair, Meeting>& met) const;
  void meet_around(std::size_t cell, std::map<Pair, Meeting>& met) const;

  double reach_;
  Vec3 low_ = Vec3::Zero();
  double edge_ = 0;
  std::array<std::int64_t, 3> counts_{1, 1, 1};
  std::vector<std::int64_t> first_;  ///< by cell: its first part, or -1
  std::vector<Part> parts_;
};

// How far the motions of rigid frames alone have brought particles towards each other since the
// lists were built. Particles are grouped by co-moving frame; x(t) = T (x(0) + s) + e, with T the
// frame's motion and s, e bounded in length. Two particles of one frame approach by at most 2 |e|;
// two of frames A and B by |(T_A - T_B) x| more, which is largest at a corner of a box around the
// particles concerned, less the distance by which they exceeded the lists' range.

/// The motion since a reference pose: x -> turn x + shift.
struct RigidMotion {
  Mat3 turn = Mat3::Identity();
  Vec3 shift = Vec3::Zero();
};

/// Of each frame from `before` to `now`, and of the scene, which is at rest, as the last.
std::vector<RigidMotion> motions_between(const Pose& before, const Pose& now);

class Contacts {
 public:
  Contacts() = default;
  /// `comoving_frame`: the group of each particle, below `groups`. Lists hold the pairs within
  /// `range` (m).
  template <class Real>
  Contacts(const BlockState<Real>& state, const Units& units,
           std::span<const std::uint32_t> comoving_frame, std::size_t groups, double range);

  /// How much nearer the frames' motions since the reference may have brought particles that the
  /// lists do not pair, m, when no particle is more than `shift` (m) from its place. The lists are
  /// valid as long as this plus 2 |e| is below range - b.
  double approach(std::span<const RigidMotion> motions, double shift = 0) const;
  /// The same for pairs in the lists, counting only what was added after `earlier`, when no
  /// particle was farther than `moved` (m) from its T x(0).
  double approach_since(std::span<const RigidMotion> earlier, std::span<const RigidMotion> motions,
                        double moved, double shift = 0) const;
  /// Upper bound of a group's distance from `point` at the reference, m; 0 for an empty group.
  double reach_from(const Vec3& point, std::size_t group) const;

 private:
  struct Pair {
    std::size_t a, b;
    Box near_a, near_b;  ///< the particles of either within reach of the other's; empty: none
    double gap;          ///< lower bound of their distance, m
  };

  bool apart(const Pair& pair, std::span<const Vec3> centers, double shift) const;
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

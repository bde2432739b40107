// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces of a body, and boxes around several of them, around several of those, and so on up to one:
// finds what is near a piece, whose neighbors in memory are mostly its neighbors in space.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include <sinew/core/vector.h>

namespace sinew {

/// A piece at a survey. Lengths and times in any unit.
struct PieceNow {
  Box box;                     ///< around its particles
  Vec3 center = Vec3::Zero();  ///< where its velocity field has `velocity`
  Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();
  /// Another box around its particles, from the center along axes of its own, the columns; empty:
  /// the same one.
  Mat3 axes = Mat3::Identity();
  Box along = {};
  Eigen::Index shortest = 0;  ///< side of that one; found by the survey

  Vec3 velocity_at(const Vec3& p) const { return velocity + spin.cross(p - center); }
  /// Middle of the box along its axes.
  Vec3 middle() const { return center + axes * along.center(); }
};

/// No two particles of both are nearer to each other.
double gap_between(const PieceNow& one, const PieceNow& other);
/// Nor than this, along the shortest side of the first.
double gap_across(const PieceNow& one, const PieceNow& other);

class PieceTree {
 public:
  PieceTree() = default;
  /// `drift`: how much farther particles may be than its box, by piece; `bound_to`: those with the
  /// same number are bound to each other, but for -1; empty: none are.
  PieceTree(const std::vector<PieceNow>& pieces, std::span<const double> drift,
            std::span<const std::int32_t> bound_to);

  /// Calls visit(other) for the pieces, itself included, that may come within `reach` of one's
  /// boxes, ascending; but not for those that are bound to `group`.
  template <class Visit>
  void for_each_near(const PieceNow& one, double reach, std::int32_t group,
                     const Visit& visit) const {
    if (levels_.empty() || levels_.back().empty()) return;
    const Vec3 across = one.axes.col(one.shortest);
    const Query query{one.box,
                      reach * reach,
                      across,
                      across.cwiseAbs(),
                      across.dot(one.middle()),
                      reach + one.along.sizes()[one.shortest] / 2,
                      group};
    descend(levels_.size() - 1, 0, query, visit);
  }

 private:
  static constexpr std::size_t branches = 4;
  static constexpr std::int32_t none = -1;

  struct Node {
    Box box;
    std::int32_t group = none;  ///< to which all pieces below are bound
  };
  struct Query {
    Box box;
    double reach2;
    Vec3 across, lengths;  ///< the shortest side's direction, and its coordinates' absolute values
    double middle, half;   ///< along it, and how far others may be from there
    std::int32_t group;

    bool reaches(const Node& node) const {
      if (group != none && node.group == group) return false;
      const Vec3 &low = node.box.min(), &high = node.box.max();
      const Vec3 gap = (low - box.max()).cwiseMax(box.min() - high).cwiseMax(0);
      return gap.squaredNorm() < reach2 &&
             std::abs(across.dot(low + high) / 2 - middle) - lengths.dot(high - low) / 2 < half;
    }
  };

  template <class Visit>
  void descend(std::size_t level, std::size_t node, const Query& query, const Visit& visit) const {
    if (!query.reaches(levels_[level][node])) return;
    if (level == 0) return visit(static_cast<std::uint32_t>(node));
    const std::size_t end = std::min((node + 1) * branches, levels_[level - 1].size());
    for (std::size_t child = node * branches; child < end; ++child)
      descend(level - 1, child, query, visit);
  }

  std::vector<std::vector<Node>> levels_;
};

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// Groups that change while a body moves. It is divided into cubic cells; those that move affinely
// with their neighbors, or by one cubic with all that follows their assembly of bones, join a
// group, those that forces pull out of its motion, or a joint that begins to move, leave it. Rates
// are judged by what they come to until the next check.
//
//     DynamicGroups dynamic(body, motion, options);
//     if (dynamic.must_split(now, constrained))
//       next = dynamic.regroup(now, constrained, particles);
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <set>
#include <span>
#include <vector>

#include <sinew/body/grouping.h>
#include <sinew/core/cell_grid.h>
#include <sinew/core/particles.h>
#include <sinew/groups/bone_assemblies.h>
#include <sinew/groups/dynamic/moving_units.h>
#include <sinew/groups/make_grouping.h>

namespace sinew {

/// A moment of the run.
struct GroupingMoment {
  double time = 0;      ///< s
  double interval = 0;  ///< until the next check, s
  /// Moment (s) from which each bone's joint with its parent counts as still; below 0: it moves.
  std::vector<double> still_since = {};
};

struct NewGroups {
  std::vector<std::int32_t> group;  ///< one per particle id, -1: free; numbered anyhow
  std::vector<double> still_since;
};

class DynamicGroups {
 public:
  DynamicGroups(std::shared_ptr<const Body> body, Motion motion, double mass,
                const DynamicOptions& options);

  const DynamicOptions& options() const { return options_; }
  const SharedNeighbors& neighbors() const { return near_; }
  /// The cell of each particle, by id.
  const std::vector<std::int32_t>& cells() const { return cell_; }
  std::size_t cell_count() const { return count_; }

  /// Whether groups constrain a cell too much, or a still joint moves until the next check.
  bool must_split(const GroupingMoment& now, std::span<const ConstrainedCell> constrained) const;
  /// Whether at least so many particles are free that might join.
  bool may_join(const GroupingMoment& now, std::size_t enough) const;
  /// `particles`: at the moment, in any order.
  NewGroups regroup(const GroupingMoment& now, std::span<const ConstrainedCell> constrained,
                    const Particles& particles) const;

 private:
  /// What new groups follow from.
  struct Asked {
    const GroupingMoment& now;
    const std::vector<bool>& moves;  ///< one per bone: whether its joint with its parent moves
    const std::vector<std::uint8_t>& torn;  ///< one per cell: nothing of it joins
    const Particles& particles;
    std::set<int> bend;  ///< assemblies with cubic groups, which have no affine ones
  };

  bool is_constrained_above(double fraction, const ConstrainedCell& cell) const;
  double relative_residual(const GroupingMoment& now, bool was_grouped, const Residual& off) const;
  std::vector<bool> moving(const GroupingMoment& now, double ahead) const;
  std::vector<std::uint8_t> torn_around(std::span<const ConstrainedCell> constrained) const;
  void grow(const GroupingMoment& now, std::vector<Unit>& units) const;
  void bend(const GroupingMoment& now, MovingUnits& units) const;
  void add_groups(Asked& asked, bool cubic, std::int32_t first,
                  std::vector<std::int32_t>& group) const;

  std::shared_ptr<const Body> body_;
  Motion motion_;
  DynamicOptions options_;
  double max_constraint_;  ///< m/s^2
  SharedNeighbors near_;
  std::vector<std::int32_t> cell_;
  std::array<std::int32_t, 3> cells_along_{};
  std::size_t count_ = 0;
};

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// Groups that change while a body moves. It is divided into cubic cells; those that move affinely
// with their neighbors join a group, those that forces pull out of its motion, or a joint that
// begins to move, leave it. Rates are judged by what they come to until the next check.
//
//     DynamicGroups dynamic(body, motion, options);
//     if (dynamic.must_split(now, held)) next = dynamic.regroup(now, held, particles);
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <sinew/core/particles.h>
#include <sinew/physics/hierarchy/bone_parts.h>
#include <sinew/physics/hierarchy/grouping.h>
#include <sinew/physics/hierarchy/groups.h>

namespace sinew {

struct DynamicOptions {
  double joint_distance = 1;  ///< of joints that move, as in StaticGroups
  /// In radii. What joins a group is moved by less (root mean square, half as much where it was
  /// free); what leaves it would be, by the forces that hold it there.
  double tolerance = 0.05;
  std::size_t least = 4096;  ///< particles of a group
};

/// A moment of the run.
struct GroupingMoment {
  double time = 0;      ///< s
  double interval = 0;  ///< until the next check, s
  /// By bone, since when its joint with its parent has counted as still, s; below 0: it moves.
  std::vector<double> still_since = {};
};

struct NewGroups {
  std::vector<std::int32_t> group;  ///< by particle id, -1: free; numbered anyhow
  std::vector<double> still_since;
};

class DynamicGroups {
 public:
  DynamicGroups(std::shared_ptr<const Body> body, Motion motion, double mass,
                const DynamicOptions& options);

  /// The cell of each particle, by id.
  const std::vector<std::int32_t>& cells() const { return cell_; }
  std::size_t cell_count() const { return count_; }

  /// Whether a cell is held too strongly, or a joint that was still moves until the next check.
  bool must_split(const GroupingMoment& now, std::span<const HeldCell> held) const;
  /// `particles`: at the moment, in any order.
  NewGroups regroup(const GroupingMoment& now, std::span<const HeldCell> held,
                    const Particles& particles) const;

 private:
  /// Of a unit: the particles of a cell that follow the same part.
  struct Unit;
  using Units = std::vector<Unit>;

  bool is_held_above(double share, const HeldCell& cell) const;
  std::vector<bool> moving(const GroupingMoment& now, double ahead) const;
  std::vector<std::uint8_t> torn_around(std::span<const HeldCell> held) const;
  std::vector<std::int32_t> find_units(const BoneParts& parts, Units& units) const;
  void measure(const Particles& particles, std::span<const std::int32_t> unit, Units& units) const;
  void grow(const GroupingMoment& now, Units& units) const;

  std::shared_ptr<const Body> body_;
  Motion motion_;
  DynamicOptions options_;
  double most_held_;  ///< m/s^2
  std::vector<std::int32_t> cell_;
  std::array<std::int32_t, 3> cells_along_{};
  std::size_t count_ = 0;
};

}  // namespace sinew

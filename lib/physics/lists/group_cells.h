// SPDX-License-Identifier: GPL-3.0-or-later
// Where the particles of different groups come near each other.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "core/vector.h"
#include "physics/lists/block_state.h"

namespace sinew {

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
  GroupCells(const BlockState<Real>& state, const Measure& measure,
             std::span<const std::uint32_t> group, double reach);

  const std::vector<Part>& parts() const { return parts_; }

  struct Meeting {
    Box near_a, near_b;  ///< around the particles of either group within reach of the other's, m
    double gap;          ///< lower bound of their distance, m
  };
  using Pair = std::pair<std::size_t, std::size_t>;  ///< the lower group first
  /// Of all groups that come within reach.
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

}  // namespace sinew

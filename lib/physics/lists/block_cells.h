// SPDX-License-Identifier: GPL-3.0-or-later
// The paper's cells, holding blocks instead of particles: which blocks have a particle where.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "physics/lists/block_state.h"

namespace sinew {

class BlockCells {
 public:
  /// Cells whose edge is `range` (in lengths of the kernel) or more.
  template <class Real>
  BlockCells(BlockState<Real>& state, double unit, double range);

  std::size_t cells() const {
    return static_cast<std::size_t>(counts_[0] * counts_[1] * counts_[2]);
  }
  const std::array<std::int64_t, 3>& counts() const { return counts_; }
  double edge() const { return edge_; }
  /// The cell of each particle.
  std::span<const std::uint32_t> cell_of_particle() const { return cell_; }
  /// Bounds of the cell's particles: its own box, in lengths from the corner of the grid.
  const Vec3& low() const { return low_; }

  /// Finds the blocks with a particle in the cells around those of a block's particles.
  class Finder {
   public:
    explicit Finder(const BlockCells& cells);
    /// Ascending; itself among them.
    const std::vector<std::uint32_t>& around(std::size_t block);

   private:
    void add_around(std::uint32_t cell);

    const BlockCells& cells_;
    std::vector<std::uint32_t> seen_;  ///< by block: the last one that found it, counted from 1
    std::vector<std::uint32_t> found_;
    std::uint32_t now_ = 0;
  };

 private:
  template <class Real>
  void size_cells(BlockState<Real>& state, double unit, double range);
  template <class Real>
  void assign(BlockState<Real>& state, double unit);
  void sort();
  /// Calls visit(cell) for the distinct cells of a block's particles.
  template <class Visit>
  void for_each_cell(std::size_t block, Visit&& visit) const;

  std::size_t block_size_;
  std::size_t blocks_;
  Vec3 low_ = Vec3::Zero();
  double edge_ = 0;
  std::array<std::int64_t, 3> counts_{1, 1, 1};
  std::vector<std::uint32_t> cell_;   ///< by particle
  std::vector<std::uint32_t> first_;  ///< by cell: where its blocks begin in `inside_`
  std::vector<std::uint32_t> inside_;
};

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// The paper's cell grid over blocks instead of particles: which blocks have particles in a cell.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include <sinew/physics/lists/block_state.h>

namespace sinew {

class BlockCells {
 public:
  BlockCells() = default;
  /// Cells whose edge is `range` (in lengths of the kernel) or more.
  template <class Real>
  BlockCells(BlockState<Real>& state, double range);

  std::size_t cells() const {
    return static_cast<std::size_t>(counts_[0] * counts_[1] * counts_[2]);
  }
  const std::array<std::int64_t, 3>& counts() const { return counts_; }
  double edge() const { return edge_; }
  /// The cell of each particle.
  std::span<const std::uint32_t> cell_of_particle() const { return cell_; }
  /// Frees it: it takes the most memory.
  void forget_particles() { std::vector<std::uint32_t>().swap(cell_); }
  /// Corner of the grid, in lengths of the kernel.
  const Vec3& low() const { return low_; }

  /// Calls visit(block) for the blocks with a particle within two edges of a point (in lengths of
  /// the kernel), and for others; for some more than once.
  template <class Visit>
  void for_each_block_near(const Vec3& point, Visit&& visit) const {
    std::array<std::int64_t, 3> from, to;
    for (int axis = 0; axis < 3; ++axis) {
      const double at = std::floor((point[axis] - low_[axis]) / edge_);
      const auto last = static_cast<double>(counts_[axis] - 1);
      from[axis] = static_cast<std::int64_t>(std::clamp(at - 2, 0.0, last));
      to[axis] = static_cast<std::int64_t>(std::clamp(at + 2, 0.0, last));
    }
    for (std::int64_t k = from[2]; k <= to[2]; ++k)
      for (std::int64_t j = from[1]; j <= to[1]; ++j) {
        const std::int64_t row = (k * counts_[1] + j) * counts_[0];
        for (std::uint32_t p = first_[row + from[0]]; p < first_[row + to[0] + 1]; ++p)
          visit(inside_[p]);
      }
  }

  /// Finds the blocks with a particle in the cells around those of a block's particles.
  class Finder {
   public:
    explicit Finder(const BlockCells& cells);
    /// Calls visit(other) for each of them in ascending order, the block itself included.
    template <class Visit>
    void for_each_around(std::size_t block, Visit&& visit) {
      mark(block);
      for (const std::uint32_t word : words_) {
        for (std::uint64_t bits = found_[word]; bits != 0; bits &= bits - 1)
          visit(64 * word + static_cast<std::uint32_t>(std::countr_zero(bits)));
        found_[word] = 0;
      }
    }

   private:
    void mark(std::size_t block);
    void mark_around(std::uint32_t cell);
    void mark_row(std::int64_t from, std::int64_t to);

    const BlockCells& cells_;
    std::vector<std::uint32_t> last_;  ///< by cell: the last block it was visited for, from 1
    std::uint32_t now_ = 0;
    std::vector<std::uint64_t> found_;  ///< a bit for each block
    std::vector<std::uint32_t> words_;  ///< of found_ that are not zero, ascending when marked
  };

 private:
  template <class Real>
  void size_cells(BlockState<Real>& state, double range);
  template <class Real>
  void assign(BlockState<Real>& state);
  void sort();
  /// Calls visit(cell) for the distinct cells of a block's particles.
  template <class Visit>
  void for_each_cell(std::size_t block, Visit&& visit) const;

  std::size_t block_size_ = 1;
  std::size_t blocks_ = 0;
  Vec3 low_ = Vec3::Zero();
  double edge_ = 0;
  std::array<std::int64_t, 3> counts_{1, 1, 1};
  std::vector<std::uint32_t> cell_;   ///< by particle
  std::vector<std::uint32_t> first_;  ///< by cell: where its blocks begin in `inside_`
  std::vector<std::uint32_t> inside_;
};

}  // namespace sinew

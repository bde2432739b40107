// SPDX-License-Identifier: GPL-3.0-or-later
// For each block, the distinct differences j - i of its pairs within a range: see kernel/kernel.h.
#pragma once

#include <algorithm>
#include <compare>
#include <cstdint>
#include <vector>

#include <sinew/physics/kernel/kernel.h>
#include <sinew/physics/lists/block_cells.h>
#include <sinew/physics/lists/block_state.h>

namespace sinew {

// An order in which particles close in space are close in memory: columns of cells across the
// longest side of the body, back and forth, each sorted along it. A freshly packed body keeps the
// rows of its lattice, which are better still; this is for bodies that have flowed, and for any
// other order.

/// Places in `state` in that order; columns are `edge` wide (in lengths of the kernel).
template <class Real>
std::vector<std::uint32_t> order_by_columns(BlockState<Real>& state, double edge);

/// Particle order[k] of `from` becomes particle k of `to`, which has the same size.
template <class Real>
void reorder(BlockState<Real>& from, const std::vector<std::uint32_t>& order, BlockState<Real>& to);

/// One difference of one block.
struct BlockOffset {
  std::uint32_t block;
  std::int32_t offset;
  friend auto operator<=>(const BlockOffset&, const BlockOffset&) = default;
};

struct OffsetLists {
  std::vector<std::uint32_t> first;  ///< blocks + 1 long
  std::vector<std::int32_t> value;   ///< ascending within a block

  kernel::Lists arrays() const { return {first.data(), value.data()}; }
  bool has(BlockOffset one) const {
    const auto begin = value.begin();
    return std::binary_search(begin + first[one.block], begin + first[one.block + 1], one.offset);
  }
  /// Differences per block, on average.
  double mean() const;
};

/// The lists with more differences, in any order and more than once.
OffsetLists with_added(const OffsetLists& lists, std::vector<BlockOffset> added);

/// All pairs closer than `range` (in lengths of the kernel; no longer than an edge of the cells).
template <class Real>
OffsetLists find_offsets(const kernel::Functions<Real>& kernel, BlockState<Real>& state,
                         const BlockCells& cells, double range);

/// Those among `outer` that have a pair closer than `range`.
template <class Real>
OffsetLists prune_offsets(const kernel::Functions<Real>& kernel, BlockState<Real>& state,
                          const OffsetLists& outer, double range);

}  // namespace sinew

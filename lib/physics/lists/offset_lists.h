// SPDX-License-Identifier: GPL-3.0-or-later
// For each block the distinct differences j - i of its pairs within a range: see kernel.h.
#pragma once

#include <algorithm>
#include <compare>
#include <cstdint>
#include <vector>

#include "physics/kernel/kernel.h"
#include "physics/lists/block_cells.h"
#include "physics/lists/block_state.h"

namespace sinew {

/// A difference of one block.
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

/// Those among `wider` that have a pair closer than `range`.
template <class Real>
OffsetLists sift_offsets(const kernel::Functions<Real>& kernel, BlockState<Real>& state,
                         const OffsetLists& wider, double range);

}  // namespace sinew

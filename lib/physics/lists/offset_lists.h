// SPDX-License-Identifier: GPL-3.0-or-later
// For each block the distinct differences j - i of its pairs within a range: see kernel.h.
#pragma once

#include <cstdint>
#include <vector>

#include "physics/kernel/kernel.h"
#include "physics/lists/block_cells.h"
#include "physics/lists/block_state.h"

namespace sinew {

struct OffsetLists {
  std::vector<std::uint32_t> first;  ///< blocks + 1 long
  std::vector<std::int32_t> value;   ///< ascending within a block

  kernel::Lists arrays() const { return {first.data(), value.data()}; }
  /// Differences per block, on average.
  double mean() const;
};

/// All pairs closer than `range` (in lengths of the kernel; no longer than an edge of the cells).
template <class Real>
OffsetLists find_offsets(const kernel::Functions<Real>& kernel, BlockState<Real>& state,
                         double unit, const BlockCells& cells, double range);

/// Those among `wider` that have a pair closer than `range`.
template <class Real>
OffsetLists sift_offsets(const kernel::Functions<Real>& kernel, BlockState<Real>& state,
                         double unit, const OffsetLists& wider, double range);

}  // namespace sinew

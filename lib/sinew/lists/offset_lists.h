// SPDX-License-Identifier: GPL-3.0-or-later
// For each block, the distinct differences j - i of its pairs within a range: see kernel/kernel.h.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <sinew/kernel/kernel.h>
#include <sinew/lists/block_state.h>
#include <sinew/lists/bond_lists.h>

namespace sinew {

/// The lists of one piece.
struct OffsetLists {
  std::vector<std::uint32_t> first;  ///< one longer than the piece has blocks
  std::vector<std::int32_t> value;   ///< ascending within a block
  std::vector<std::uint16_t> lanes;  ///< lanes that each is for; empty: all

  kernel::Lists arrays() const {
    return {first.data(), value.data(), lanes.empty() ? nullptr : lanes.data()};
  }
};

struct BlockBoxes {
  std::vector<kernel::BlockBounds> of_blocks;  ///< bounds of each piece's blocks
  std::vector<kernel::BlockBounds> of_pieces;  ///< around as many of them as a piece has blocks

  void resize(std::size_t pieces);
};

/// Renews the bounds of a piece and of its blocks.
template <class Real>
void find_boxes(const kernel::Functions<Real>& kernel, BlockState<Real>& state, std::size_t piece,
                BlockBoxes& boxes);

/// All pairs of a piece closer than `range` (in lengths of the kernel) with particles of the pieces
/// `near`, ascending, itself included, whose boxes are valid; and few barely beyond it.
template <class Real>
OffsetLists find_offsets(const kernel::Functions<Real>& kernel, BlockState<Real>& state,
                         std::size_t piece, std::span<const std::uint32_t> near,
                         const BlockBoxes& boxes, double range);

/// Without the pairs that are bonded. All of those left have lanes.
template <class Real>
void remove_bonded(const BondLists<Real>& bonds, std::size_t piece, OffsetLists& lists);

/// Keeps those among `outer` that have a pair closer than `range`.
template <class Real>
OffsetLists prune_offsets(const kernel::Functions<Real>& kernel, BlockState<Real>& state,
                          std::size_t piece, const OffsetLists& outer, double range);

}  // namespace sinew

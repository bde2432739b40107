// SPDX-License-Identifier: GPL-3.0-or-later
// Subpieces, which move on their own: particles of different bones or groups, which follow each
// other in memory, may share a piece of the kernel's blocks. Subpieces tell whose lists are valid.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <sinew/body/body.h>

namespace sinew {

struct Subpieces {
  /// First particle of each subpiece; then how many particles there are.
  std::vector<std::uint32_t> first;
  std::vector<std::uint32_t> of_block;  ///< subpiece of its first particle
  std::vector<std::uint32_t> of_piece;  ///< the first one; one longer than there are pieces
  std::vector<std::uint32_t> piece;     ///< piece of each subpiece

  std::size_t size() const { return piece.size(); }
};

/// Divides particles `id` in the kernel's order, `block` to a block. A subpiece is of one group, or
/// of one bone and no group, apart from a few particles.
Subpieces subpieces_of(const Body& body, std::span<const std::int32_t> id, std::size_t block);

}  // namespace sinew

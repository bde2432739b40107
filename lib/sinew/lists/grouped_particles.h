// SPDX-License-Identifier: GPL-3.0-or-later
// Groups of particles (groups/groups.h) as neighbor lists see them.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <sinew/lists/near_pieces.h>

namespace sinew {

/// Groups of particles, which are not always at their places (groups/groups.h).
struct GroupedParticles {
  /// Puts those of some pieces there.
  std::function<void(std::span<const std::uint32_t> pieces)> show = [](const auto&) {};
  std::span<const std::int32_t> of_piece = {};  ///< a piece's only group, or -1; empty: all are -1
  /// How a piece of one group moves.
  std::function<PieceNow(std::size_t piece)> piece_now = {};
  /// Of each piece, the logarithm of by how much distances in its group may have changed, summed
  /// up.
  std::span<const double> strain = {};
  std::span<const std::uint8_t> working = {};  ///< by piece: a step needs its lists
};

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// An order in which particles near in memory are near in space: columns of cells across the longest
// side of the body, back and forth, each sorted along. A packed body keeps the rows it was filled
// in, which are better still; this is for bodies that have flowed or came in any order.
#pragma once

#include <cstdint>
#include <vector>

#include "physics/lists/block_state.h"

namespace sinew {

/// The particles in that order, by their place in `state`; columns are `edge` wide (in lengths of
/// the kernel).
template <class Real>
std::vector<std::uint32_t> order_by_columns(BlockState<Real>& state, double edge);

/// Particle order[k] of `from` becomes particle k of `to`, which has the same size.
template <class Real>
void reorder(BlockState<Real>& from, const std::vector<std::uint32_t>& order, BlockState<Real>& to);

}  // namespace sinew

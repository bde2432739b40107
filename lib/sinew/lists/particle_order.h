// SPDX-License-Identifier: GPL-3.0-or-later
// Orders of the particles in which those close in space are close in memory.
//
//     const auto order = order_at_rest(body, particles.id);
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <sinew/body/body.h>
#include <sinew/lists/block_state.h>

namespace sinew {

/// An order of a packed body's particles `id`, as places in `id`: bone after bone, for each the
/// planes of an FCC lattice that lie most nearly across it, each row by row. So a piece of the
/// order is a slice of a limb, which moves nearly as a rigid body, and differences along rows are
/// regular. Particles on no lattice keep their order.
std::vector<std::uint32_t> order_at_rest(const Body& body, std::span<const std::int32_t> id);

/// For a body that has flowed: columns of cells across the longest side of the body, back and
/// forth, each sorted along it. Columns are `edge` wide (in lengths of the kernel).
template <class Real>
std::vector<std::uint32_t> order_by_columns(BlockState<Real>& state, double edge);

/// Particle order[k] of `from` becomes particle k of `to`, which has the same size.
template <class Real>
void reorder(BlockState<Real>& from, const std::vector<std::uint32_t>& order, BlockState<Real>& to);

}  // namespace sinew

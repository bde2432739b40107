// SPDX-License-Identifier: GPL-3.0-or-later
// The neighbors that the particles of a body have at rest. Binding, bonds, groups, warnings and
// metrics all ask for them: a start searches once, and passes them on.
//
//     const RestNeighbors near = rest_neighbors(rest, radius, material.bond.second > 0);
//     for (const std::uint32_t j : near.nearest.of(i)) visit(rest[j]);
#pragma once

#include <memory>

#include <sinew/core/cell_grid.h>
#include <sinew/core/particles.h>

namespace sinew {

/// Neighbors at rest within this are bonded where second neighbors are.
inline constexpr double second_neighbor_range = 3.1;  // in radii: the third are at 3.46

/// Neighbors by particle id, in both directions, ascending.
struct RestNeighbors {
  NeighborLists nearest;  ///< closer than rest_neighbor_range()
  /// Nearest and second ones, closer than second_neighbor_range; empty: second ones do not count.
  NeighborLists with_second;

  /// All that count.
  const NeighborLists& all() const { return with_second.size() > 0 ? with_second : nearest; }
};

/// One search among particles of `radius` (m) at `rest` (n x 3, m, by id). Throws bad input for
/// more than 2^32 neighbors. In parallel.
RestNeighbors rest_neighbors(const Points& rest, double radius, bool with_second);

/// The second neighbors alone, by id.
NeighborLists second_neighbors(const RestNeighbors& near);

/// Neighbors that several owners share, for as long as one of them needs them.
using SharedNeighbors = std::shared_ptr<const RestNeighbors>;

}  // namespace sinew

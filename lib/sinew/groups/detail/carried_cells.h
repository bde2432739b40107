// SPDX-License-Identifier: GPL-3.0-or-later
// A body cut into cells that bones carry, to find where what they carry meets something.
//
//     const std::vector<double> width = widths_of(body);
//     const std::vector<Cell> cells = cells_of(body, width);
//     on_cells(cells, [&](std::size_t n) { marks[n] = ...; });
//     return particles_of(cells, marks, body.rest.size());
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include <sinew/core/vector.h>
#include <sinew/rig/skeleton.h>

namespace sinew {

struct Body;

/// Particles next to each other at rest that a bone carries.
struct Cell {
  int bone = no_bone;
  std::vector<std::uint32_t> particles = {};
  Box box = {};  ///< around them, m

  double radius() const { return box.diagonal().norm() / 2; }
};

/// The square root of the cross-section of what each bone carries, m.
std::vector<double> widths_of(const Body& body);

/// Cells of a twelfth of these widths. What several bones hold is in cells of each; what none holds
/// in those of the nearest one.
std::vector<Cell> cells_of(const Body& body, const std::vector<double>& width);

/// In parallel.
void on_cells(const std::vector<Cell>& cells, const std::function<void(std::size_t)>& job);

/// Marks the particles of marked cells, by id, of so many.
std::vector<std::uint8_t> particles_of(const std::vector<Cell>& cells,
                                       const std::vector<std::uint8_t>& marks, std::size_t count);

}  // namespace sinew

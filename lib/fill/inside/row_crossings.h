// SPDX-License-Identifier: GPL-3.0-or-later
// Where the rows of a lattice cross a surface: one exact ray per row instead of one query per site.
// Along a row the sum of signed crossings so far is the winding number of a closed surface, and the
// cost grows with triangles and crossings, not with sites.
//
// Decisions are those of exact predicates. Where a row meets an edge or lies in a face it counts as
// shifted a little across (the first of two symbolic shifts, the second along z): so no row ever
// meets an edge, and a crossing of two triangles' common edge is counted once.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/triangles.h"
#include "fill/lattice.h"

namespace sinew {

struct Crossing {
  std::int32_t site;  ///< the first site of the row at or beyond the crossing; may be past the last
  std::int32_t face;
  std::int32_t winding;  ///< +1 where the row enters through the face's front, -1 where it leaves
};

struct RowSite {
  std::int32_t row, site;
  auto operator<=>(const RowSite&) const = default;
};

struct RowCrossings {
  std::vector<std::size_t> first;   ///< of each row, and one past the last row's end
  std::vector<Crossing> crossings;  ///< by row, then site, then face
  std::vector<RowSite> on_surface;  ///< sites exactly on a triangle, sorted, each once

  std::span<const Crossing> of(std::size_t row) const {
    return {crossings.data() + first[row], first[row + 1] - first[row]};
  }
};

/// Any triangles will do. The same for every number of threads.
RowCrossings row_crossings(const Lattice& lattice, const Triangles& surface);

}  // namespace sinew

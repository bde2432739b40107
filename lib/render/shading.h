// SPDX-License-Identifier: GPL-3.0-or-later
// How a surface is to be shaded and which of its edges are worth a line. Taken once from the rest
// surface, so that nothing flickers while the body bends.
#pragma once

#include "core/triangles.h"

namespace sinew {

struct Shading {
  using Edge = std::array<int, 2>;

  std::vector<int> source;                ///< the surface's point behind each shaded point
  std::vector<std::array<int, 3>> faces;  ///< of shaded points, which are split along creases
  std::vector<Edge> creases;              ///< of the surface's points: sharp or open edges
  std::vector<Edge> lines;                ///< its other edges, but the diagonals of quadrangles

  /// The shaded surface when the surface's points (n x 3, m) have moved to `points`.
  Triangles at(const Points& points) const;
};

/// Edges whose faces meet at more than 40 degrees are creases. A diagonal is the longest side of
/// both its triangles; when nearly all triangles pair up that way, the surface is taken as
/// quadrangles.
Shading make_shading(const Triangles& rest);

}  // namespace sinew

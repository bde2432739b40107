// SPDX-License-Identifier: GPL-3.0-or-later
// How a surface is shaded and which of its edges are drawn, and the soft shadows of a picture.
// Determined once from the rest surface, so that nothing flickers while the body bends.
//
//     const Triangles shaded = make_shading(rest).at(points);
#pragma once

#include <vector>

#include <sinew/core/triangles.h>

namespace sinew {

struct Shading {
  using Edge = std::array<int, 2>;

  std::vector<int> source;                ///< the surface's point behind each shaded point
  std::vector<std::array<int, 3>> faces;  ///< corners: shaded points, which are split along creases
  std::vector<Edge> creases;              ///< pairs of the surface's points: sharp or open edges
  std::vector<Edge> lines;                ///< its other edges, except diagonals of quadrangles
  double mean_line = 0;                   ///< mean length of these at rest, m

  /// The shaded surface when the surface's points (n x 3, m) have moved to `points`.
  Triangles at(const Points& points) const;
};

/// Edges whose faces meet at more than 40 degrees are creases. A diagonal is the longest side of
/// both its triangles; where nearly all triangles form such pairs, the surface is treated as made
/// of quadrangles.
Shading make_shading(const Triangles& rest);

// Soft shadows in hollows and between touching objects, from the depths of a picture: the part of
// the sky over each pixel that its neighborhood hides (screen-space ambient occlusion, Mittring
// 2007, measured by the elevation over the tangent plane).

/// Distance from the viewer behind each pixel of a parallel projection, rows from the top.
struct DepthImage {
  int width = 0, height = 0;
  double pixel = 1;          ///< size of one, m
  std::vector<float> depth;  ///< m; infinite in the background

  float at(int x, int y) const { return depth[static_cast<std::size_t>(y) * width + x]; }
};

/// 0 (open) .. 1 (hidden) for each pixel, from what lies within `radius` (m). Runs in parallel.
std::vector<float> occlusion(const DepthImage& image, double radius);

}  // namespace sinew

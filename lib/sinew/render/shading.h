// SPDX-License-Identifier: GPL-3.0-or-later
// How a surface is to be shaded and which of its edges are worth a line. Taken once from the rest
// surface, so that nothing flickers while the body bends.
#pragma once

#include <vector>

#include <sinew/core/triangles.h>

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

// Soft shadows in hollows and between touching things, from the depths of a picture: how much of
// the sky over each pixel its neighborhood hides (screen-space ambient occlusion, Mittring 2007,
// with the elevation over the tangent plane as measure).

/// Distance from the viewer behind each pixel of a parallel projection, rows from the top.
struct DepthImage {
  int width = 0, height = 0;
  double pixel = 1;          ///< size of one, m
  std::vector<float> depth;  ///< m; infinite where there is nothing

  float at(int x, int y) const { return depth[static_cast<std::size_t>(y) * width + x]; }
};

/// 0 (open) .. 1 (hidden) for each pixel, from what lies within `radius` (m). Runs in parallel.
std::vector<float> occlusion(const DepthImage& image, double radius);

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// Soft shadows in hollows and between touching things, from the depths of a picture: how much of
// the sky over each pixel its neighbourhood hides (screen-space ambient occlusion, Mittring 2007,
// with the elevation over the tangent plane as measure).
#pragma once

#include <vector>

namespace sinew {

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

// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/occlusion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/parallel.h"
#include "core/vector.h"

namespace sinew {
namespace {

constexpr int samples = 16, rotations = 16;  // a 4 x 4 pattern of turns, blurred away afterwards

struct Offset {
  int x, y;
  float distance;  ///< m
};
using Discs = std::array<std::array<Offset, samples>, rotations>;

/// A sunflower's seeds, evenly over the disc, once for each turn.
Discs make_discs(double radius, double pixel) {
  constexpr double golden_angle = 2.399963;
  Discs discs;
  for (int turn = 0; turn < rotations; ++turn)
    for (int i = 0; i < samples; ++i) {
      const double far = std::max(1.0, radius / pixel * std::sqrt((i + 0.5) / samples));
      const double angle = golden_angle * i + 2 * pi * turn / rotations;
      const int x = static_cast<int>(std::lround(far * std::cos(angle)));
      const int y = static_cast<int>(std::lround(far * std::sin(angle)));
      discs[turn][i] = {x, y, static_cast<float>(pixel * std::hypot(x, y))};
    }
  return discs;
}

/// Infinite outside of the picture, as where there is nothing.
float depth_at(const DepthImage& image, int x, int y) {
  const bool inside = x >= 0 && y >= 0 && x < image.width && y < image.height;
  return inside ? image.at(x, y) : std::numeric_limits<float>::infinity();
}

/// Change of depth per pixel: of the two sides the flatter one, as the other may be another thing.
float slope(float before, float here, float after) {
  const float left = here - before, right = after - here;
  const float flatter = std::abs(left) < std::abs(right) ? left : right;
  return std::isfinite(flatter) ? flatter : 0;
}

float hidden(const DepthImage& image, const Discs& discs, float radius, int x, int y) {
  const float here = image.at(x, y);
  if (!std::isfinite(here)) return 0;
  const float along_x = slope(depth_at(image, x - 1, y), here, depth_at(image, x + 1, y));
  const float along_y = slope(depth_at(image, x, y - 1), here, depth_at(image, x, y + 1));
  constexpr std::array<int, rotations> order{0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5};
  float sum = 0;
  for (const auto& [dx, dy, distance] : discs[order[4 * (y % 4) + x % 4]]) {
    const float plane = here + along_x * static_cast<float>(dx) + along_y * static_cast<float>(dy);
    const float above = plane - depth_at(image, x + dx, y + dy);
    if (!(above > 0.04F * radius)) continue;  // also nothing there: infinitely far below
    const float near = radius / std::max(radius, above);  // what is far in front hides less
    sum += near * near * above / std::hypot(above, distance);
  }
  return sum / samples;
}

std::vector<float> blurred(const std::vector<float>& values, int width, int height) {
  std::vector<float> means(values.size());
  parallel_for(static_cast<std::size_t>(height), 16, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
      for (int x = 0; x < width; ++x) {
        float sum = 0;
        for (int row = y - 1; row < y + 3; ++row)
          for (int column = x - 1; column < x + 3; ++column)
            sum += values[static_cast<std::size_t>(std::clamp(row, 0, height - 1)) * width +
                          std::clamp(column, 0, width - 1)];
        means[static_cast<std::size_t>(y) * width + x] = sum / 16;
      }
  });
  return means;
}

}  // namespace

std::vector<float> occlusion(const DepthImage& image, double radius) {
  const Discs discs = make_discs(radius, image.pixel);
  std::vector<float> result(image.depth.size());
  parallel_for(static_cast<std::size_t>(image.height), 16, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
      for (int x = 0; x < image.width; ++x)
        result[static_cast<std::size_t>(y) * image.width + x] =
            hidden(image, discs, static_cast<float>(radius), x, y);
  });
  return blurred(result, image.width, image.height);
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/image.h"

#include <algorithm>
#include <cmath>

namespace sinew {

Image::Image(int columns, int rows, const Colour& colour)
    : width(columns), height(rows), rgb(3 * static_cast<std::size_t>(columns) * rows) {
  fill(*this, 0, 0, columns, rows, colour);
}

Image halved(const Image& image) {
  Image half(image.width / 2, image.height / 2);
  for (int y = 0; y < half.height; ++y)
    for (int x = 0; x < half.width; ++x) {
      const std::uint8_t* above = image.at(2 * x, 2 * y);
      const std::uint8_t* below = image.at(2 * x, 2 * y + 1);
      for (int c = 0; c < 3; ++c)
        half.at(x, y)[c] =
            static_cast<std::uint8_t>((above[c] + above[c + 3] + below[c] + below[c + 3] + 2) / 4);
    }
  return half;
}

void paste(Image& image, const Image& part, int x, int y) {
  const int left = std::max(0, -x), right = std::min(part.width, image.width - x);
  if (right <= left) return;
  for (int row = std::max(0, -y); row < std::min(part.height, image.height - y); ++row)
    std::copy_n(part.at(left, row), 3 * (right - left), image.at(x + left, y + row));
}

void fill(Image& image, int x, int y, int width, int height, const Colour& colour) {
  for (int row = std::max(0, y); row < std::min(y + height, image.height); ++row)
    for (int column = std::max(0, x); column < std::min(x + width, image.width); ++column)
      std::copy(colour.begin(), colour.end(), image.at(column, row));
}

}  // namespace sinew

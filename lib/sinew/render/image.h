// SPDX-License-Identifier: GPL-3.0-or-later
// An image as plain bytes, the operations needed on it, and its PNG file.
//
//     Image image(640, 480);
//     write_png(halved(image), "picture.png");
#pragma once

#include <string>

#include <sinew/core/color.h>

namespace sinew {

struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;    ///< 3 bytes a pixel, rows from the top, each from the left
  std::vector<std::uint8_t> alpha;  ///< opacity of each pixel; empty: all are opaque

  Image() = default;
  Image(int columns, int rows, const Color& color = palette::paper);

  std::uint8_t* at(int x, int y) { return &rgb[3 * (static_cast<std::size_t>(y) * width + x)]; }
  const std::uint8_t* at(int x, int y) const { return const_cast<Image*>(this)->at(x, y); }
};

/// Half the width and height: the mean of 2 x 2 pixels each.
Image halved(const Image& image);

/// Antialiases edges, where neighboring pixels differ in brightness: each is blended with the one
/// across the edge (after FXAA, Lottes 2009). Runs in parallel.
Image with_smooth_edges(const Image& image);

/// Copies `part` to (x, y), its upper left corner; clipped at the borders.
void paste(Image& image, const Image& part, int x, int y);

/// Fills a rectangle, clipped at the borders.
void fill(Image& image, int x, int y, int width, int height, const Color& color);

/// The picture without its background, from drawings of it on white and on black: of what covers
/// a pixel in part, both differ in part. Throws bad input for images of different sizes.
Image cut_out(const Image& on_white, const Image& on_black);

/// The bytes of its PNG file.
std::string png_of(const Image& image);

/// Writes `path` atomically. Throws not written.
void write_png(const Image& image, const std::string& path);

}  // namespace sinew

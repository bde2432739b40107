// SPDX-License-Identifier: GPL-3.0-or-later
// Text and color bars in an image. The font is built in; no display is needed.
//
//     write_text(image, "t = 1 s", 10, 10, {.size = 16});
#pragma once

#include <string>

#include <sinew/render/image.h>
#include <sinew/render/snapshot.h>

namespace sinew {

enum class Align { left, center, right };

struct TextStyle {
  int size = 20;  ///< of the font, pixels
  Color color = palette::ink;
  Align align = Align::left;
};

/// Height of one line, pixels.
int line_height(const TextStyle& style);

/// Writes the lines of `text` (UTF-8) downward from y; x is their left end, middle or right end.
void write_text(Image& image, const std::string& text, int x, int y, const TextStyle& style);

/// The colors of `scale` from left to right with its limits, or the names of its values, below and
/// its name above, `width` pixels wide and color_bar_height() pixels high.
void draw_color_bar(Image& image, const ColorScale& scale, int x, int y, int width,
                    const TextStyle& style);
int color_bar_height(const TextStyle& style);

}  // namespace sinew

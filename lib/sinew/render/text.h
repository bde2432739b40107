// SPDX-License-Identifier: GPL-3.0-or-later
// Words in a picture. The font is built in; no display is needed.
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

/// Writes the lines of `text` (UTF-8) downwards from y; x is their left end, middle or right end.
void write_text(Image& image, const std::string& text, int x, int y, const TextStyle& style);

/// The colors of `scale` from left to right with its ends below and its name above, in a width of
/// `width` and a height of color_bar_height pixels.
void draw_color_bar(Image& image, const ColorScale& scale, int x, int y, int width,
                    const TextStyle& style);
int color_bar_height(const TextStyle& style);

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// Text in an image. The font is built in; no display is needed.
//
//     write_text(image, "t = 1 s", 10, 10, {.size = 16});
#pragma once

#include <string>

#include <sinew/render/canvas.h>

namespace sinew {

/// Writes the lines of `text` (UTF-8) downward from y; x is their left end, middle or right end.
void write_text(Image& image, const std::string& text, int x, int y, const TextStyle& style);

/// Width of the longest of its lines, pixels.
int text_width(const std::string& text, const TextStyle& style);

/// The text with lines no wider (pixels) than one word, broken after commas where that suffices.
std::string wrapped(const std::string& text, int width, const TextStyle& style);

}  // namespace sinew

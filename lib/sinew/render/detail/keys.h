// SPDX-License-Identifier: GPL-3.0-or-later
// What explains a picture on its page: the color bar, and the directions of the scene's axes.
//
//     draw_color_bar(page, scale, 20, 680, 300, {.size = 16});
//     draw_tripod(page, camera.view, 10, page.height() - 10, tripod_size(640, 480));
#pragma once

#include <sinew/render/canvas.h>
#include <sinew/render/snapshot.h>

namespace sinew {

/// The colors of `scale` from left to right with its limits, or the names of its values, below and
/// its name above, `width` pixels wide and color_bar_height() pixels high.
void draw_color_bar(Canvas& page, const ColorScale& scale, int x, int y, int width,
                    const TextStyle& style);
int color_bar_height(const TextStyle& style);
/// Width that its words need, pixels.
int color_bar_width(const ColorScale& scale, const TextStyle& style);

/// Length of an axis that lies in the picture, for a panel of this size, pixels.
int tripod_size(int width, int height);

/// X, Y and Z in red, green and blue as `view` (rows: right, up, toward the viewer) shows them, in
/// a square above and to the right of (x, y), about 2.8 times `size` wide.
void draw_tripod(Canvas& page, const Mat3& view, int x, int y, int size);

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// A body from the front, from the side and, if it is flat, from above, to one scale, with axes in
// meters.
//
//     write_png(elevations(painter, snapshot, {.width = 1280}).pixels(), "scene.png");
#pragma once

#include <cstdint>
#include <vector>

#include <sinew/render/canvas.h>
#include <sinew/render/picture.h>

namespace sinew {

/// Round numbers (1, 2 or 5 times a power of ten apart) from the last one below `low` to the first
/// one above `high`.
struct Ticks {
  int mantissa = 1, exponent = 0;    ///< parts of the step
  std::int64_t first = 0, last = 1;  ///< in steps

  double at(std::int64_t tick) const;
  /// The tick from which others are counted: 0, or one of them where all are many steps from 0.
  std::int64_t base() const;
  double low() const { return at(first); }
  double high() const { return at(last); }
};

/// `step`: the least distance between ticks, > 0.
Ticks ticks_over(double low, double high, double step);

struct ElevationOptions {
  int width = 1280, height = 720;  ///< pixels
  Finish finish = Finish::fine;
  Paper paper = {};
};

/// Front (x to the right) and side (y to the right), z up, as View::plan shows them, and the top (y
/// up) of a body that is less than half as high as it is long and wide; below them the caption, and
/// what balls and colors mean. Throws as Painter::draw does.
Canvas elevations(Painter& painter, const Snapshot& snapshot, const ElevationOptions& options);

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// The scale of a chart: round ticks, their texts, and where a value lies on the page.
#pragma once

#include <string>
#include <vector>

namespace sinew {

struct Axis {
  double low = 0, high = 1;        ///< of the scale
  std::vector<double> ticks;       ///< multiples of 1, 2 or 5 times a power of ten within it
  std::vector<std::string> texts;  ///< of the ticks, as few decimals as tell them apart
};

/// A scale whose ends are ticks, around [low, high] (finite); about `count` ticks.
Axis round_axis(double low, double high, int count);

/// A scale from low to high exactly.
Axis tight_axis(double low, double high, int count);

/// Where `value` lies between `from` and `to` when the axis runs from the one to the other.
double place_on(const Axis& axis, double value, double from, double to);

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// Line charts against time as inline SVG, with the bones' angle in a strip beneath.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace sinew {

struct Line {
  std::string name;
  std::vector<double> values;  ///< one per time; gaps where not-a-number
};

struct Chart {
  std::string title, note, unit;  ///< what it shows; one line about it; "" for pure numbers
  std::vector<double> times;      ///< ascending, s
  std::vector<Line> lines;
  std::vector<double> baselines;  ///< values the scale shows in any case
  std::vector<double> angles;     ///< of the bones, degrees, one per time
};

/// Whether a value has a place on a chart: not-a-number is a gap, and so is what would overflow the
/// scale's arithmetic.
bool drawable(double value);

/// The places of the values worth drawing: all, or the smallest and the largest of each of some
/// hundred pieces, in order.
std::vector<std::size_t> drawn_places(const std::vector<double>& values);

/// The chart with its title and legend as a figure. Lines of more points than can be told apart are
/// thinned to their extremes.
std::string chart_html(const Chart& chart);

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// Line charts against time as inline SVG, with the bones' angle in a strip beneath.
#pragma once

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

/// The chart with its title and legend as a figure. Lines of more points than can be told apart are
/// thinned to their extremes.
std::string chart_html(const Chart& chart);

}  // namespace sinew

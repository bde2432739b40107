// SPDX-License-Identifier: GPL-3.0-or-later
// Which metrics the report draws together, in which unit, and how many of their values.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sinew/metrics/frame_metrics.h>

namespace sinew {

enum class Shown { as_is, in_radii, in_percent, since_start };

/// Some scenes have nothing that a chart is about.
enum class Drawn { always, unless_zero };

struct ChartPlan {
  std::string_view title, note, unit;     ///< unit: "" for pure numbers
  std::vector<std::string_view> metrics;  ///< names in metrics_table(), at most six
  Shown shown = Shown::as_is;
  std::vector<double> baselines = {0};  ///< values the scale shows in any case
  Drawn drawn = Drawn::always;
};

struct Line {
  std::string name;
  std::vector<double> values;  ///< one per frame; gaps where not-a-number
};

struct Chart {
  std::string title, note, unit;
  std::vector<double> baselines;
  Drawn drawn = Drawn::always;
  std::vector<Line> lines;
};

/// The report's charts, the most telling first.
std::span<const ChartPlan> chart_plans();

/// Metrics whose worst frames one looks at first; names in metrics_table().
std::span<const std::string_view> telling_metrics();

/// The frames' values of a metric in the plan's unit; radius in m.
std::vector<double> shown_values(const ChartPlan& plan, std::string_view metric,
                                 std::span<const FrameMetrics> frames, double radius);

/// A chart with a line of each of its metrics.
Chart planned_chart(const ChartPlan& plan, std::span<const FrameMetrics> frames, double radius);

/// Leaves out lines that were never measured, and charts that have nothing to draw.
void leave_out_empty(std::vector<Chart>& charts);

/// The places of the values worth drawing, in order: all of up to most_drawn, else of each of some
/// hundred pieces the smallest, the largest, and a gap if it has any.
std::vector<std::size_t> drawn_places(const std::vector<double>& values);
inline constexpr std::size_t most_drawn = 1200;

/// Whether a value has a place on a chart: not-a-number is a gap, and so is what would overflow the
/// arithmetic of a scale.
bool drawable(double value);

}  // namespace sinew

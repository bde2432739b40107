// SPDX-License-Identifier: GPL-3.0-or-later
// Which metrics the report draws in one chart, in which unit, and which of their values.
//
//     for (const ChartPlan& plan : chart_plans())
//       charts.push_back(planned_chart(plan, frames, radius));
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sinew/metrics/frame_metrics.h>

namespace sinew {

enum class Shown { as_is, in_radii, in_percent, since_start };

/// A chart of a feature that the scene lacks is zero throughout and may be left out.
enum class Drawn { always, unless_zero };

/// What a chart tells of. A page shows them in this order: that of what happened.
enum class Topic { motion, deformation, forces, remains, numerics };

struct ChartedMetric {
  std::string_view name;   ///< in metrics_table()
  std::string_view words;  ///< in the legend
};

struct ChartPlan {
  std::string_view title, note, unit;  ///< unit: "" for pure numbers
  std::vector<ChartedMetric> metrics;  ///< at most six
  Shown shown = Shown::as_is;
  double span = 0;  ///< the scale spans as much, so that trifles look like trifles
  std::vector<double> baselines = {0};  ///< values that the scale always includes
  Drawn drawn = Drawn::always;
  Topic topic = Topic::motion;
};

struct Line {
  std::string name;
  std::vector<double> values;  ///< one per frame; gaps where not-a-number
};

struct Chart {
  std::string title, note, unit;
  std::vector<double> baselines = {0};
  double span = 0;  ///< least span of the scale
  Drawn drawn = Drawn::always;
  std::vector<Line> lines = {};
  Topic topic = Topic::motion;
  std::vector<double> times = {};  ///< times of the values, s; empty: those of the frames
};

/// Largest change of any line of a chart, from its smallest to its largest value.
double largest_change(const Chart& chart);

/// Whether a chart is worth its place: its values change by a twentieth of what its scale spans at
/// least, and by more than rounding.
bool says_something(const Chart& chart);

/// The report's charts, in the order of their topics.
std::span<const ChartPlan> chart_plans();

/// Metrics whose worst frames the report links to; names in metrics_table().
std::span<const std::string_view> headline_metrics();

/// The frames' values of a metric in the plan's unit; radius in m.
std::vector<double> shown_values(const ChartPlan& plan, std::string_view metric,
                                 std::span<const FrameMetrics> frames, double radius);

/// A chart with a line of each of its metrics.
Chart planned_chart(const ChartPlan& plan, std::span<const FrameMetrics> frames, double radius);

/// Leaves out lines that were never measured, and charts that have nothing to draw.
void leave_out_empty(std::vector<Chart>& charts);

/// Puts charts in the order of their topics, those that say nothing last.
void put_in_order(std::vector<Chart>& charts);

/// Indices of the values to draw, ascending: all of up to max_drawn; of more, the smallest, the
/// largest and a gap, if any, of each of several hundred pieces.
std::vector<std::size_t> drawn_indices(const std::vector<double>& values);
inline constexpr std::size_t max_drawn = 1200;

/// Whether a value is drawn: not-a-number and values that would overflow the arithmetic of a scale
/// are gaps.
bool drawable(double value);

}  // namespace sinew

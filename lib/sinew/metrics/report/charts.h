// SPDX-License-Identifier: GPL-3.0-or-later
// Which metrics the report draws together, and in which unit.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include <sinew/metrics/frame_metrics.h>
#include <sinew/metrics/report/chart.h>

namespace sinew {

enum class Shown { as_is, in_radii, in_percent, since_start };

/// Some scenes have nothing that a chart is about.
enum class Drawn { always, unless_zero };

struct ChartPlan {
  std::string_view title, note, unit;
  std::vector<std::string_view> metrics;  ///< names in metrics_table(), at most six
  Shown shown = Shown::as_is;
  std::vector<double> baselines = {0};
  Drawn drawn = Drawn::always;
};

/// The report's charts, the most telling first.
std::span<const ChartPlan> chart_plans();

/// Metrics whose worst frames one looks at first; names in metrics_table().
std::span<const std::string_view> telling_metrics();

/// Whether the chart has anything to show of these frames.
bool is_drawn(const ChartPlan& plan, std::span<const FrameMetrics> frames);

/// A chart filled with the frames' numbers; radius in m.
Chart planned_chart(const ChartPlan& plan, std::span<const FrameMetrics> frames, double radius);

}  // namespace sinew

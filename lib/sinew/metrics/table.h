// SPDX-License-Identifier: GPL-3.0-or-later
// The table of metrics, from which metrics.csv, metrics.json, the report, --fail-on and the
// README's table are made. To add a metric, add its member in frame.h and its row in table.cpp.
//
//     const Metric& metric = metrics_table()[metric_index("volume_error")];
//     const double value = frame.*metric.value;
#pragma once

#include <span>
#include <string_view>

#include <sinew/core/value_range.h>
#include <sinew/metrics/frame.h>
#include <sinew/metrics/particle_values.h>
#include <sinew/metrics/summary.h>

namespace sinew {

/// Which values of a metric are worse.
enum class Worse { larger, smaller, magnitude };

/// A metric of every frame.
struct Metric {
  std::string_view name;  ///< column of metrics.csv
  std::string_view unit;  ///< "" for pure numbers
  std::string_view help;  ///< its meaning, one line
  std::string_view formula;
  double FrameMetrics::*value;
  Worse worse = Worse::larger;
  /// Values of which the metric is the worst over all particles; none where it is not of that kind.
  std::vector<double> ParticleValues::*of_particles = nullptr;
};

/// A metric of a whole run.
struct RunMetric {
  std::string_view name, unit, help, formula;
  double Summary::*value;
};

std::span<const Metric> metrics_table();  ///< the first is the time
std::span<const RunMetric> run_metrics_table();

/// The index of the metric in metrics_table(); its size where there is none of that name.
std::size_t metric_index(std::string_view name);

/// The values that a metric of that name can have; all numbers for other names.
ValueRange range_of(std::string_view name);

}  // namespace sinew

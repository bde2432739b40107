// SPDX-License-Identifier: GPL-3.0-or-later
// metrics.csv: a row per frame, a column per metric, the time first, as ParaView and spreadsheets
// open it; and metrics.json, the summary of a run for scripts.
//
//     write_file("metrics.csv", metrics_csv(frames));
//     write_file("metrics.json", metrics_json(frames, summary, checks));
#pragma once

#include <cmath>
#include <span>
#include <string>

#include <sinew/core/text.h>
#include <sinew/metrics/comparison.h>
#include <sinew/metrics/frame.h>
#include <sinew/metrics/limits.h>
#include <sinew/metrics/summary.h>

namespace sinew {

/// The whole file. Numbers read back as the same bits; "nan" where a metric was not measured.
std::string metrics_csv(std::span<const FrameMetrics> frames);

/// A line of column names, then one line per row. Numbers read back as the same bits.
template <class Table, class Rows>
std::string csv_text(const Table& columns, const Rows& rows) {
  std::string text;
  for (const auto& column : columns) {
    if (!text.empty()) text += ',';
    text += column.name;
  }
  for (const auto& row : rows) {
    char separator = '\n';
    for (const auto& column : columns) {
      const double value = row.*column.value;
      text += separator;
      text += std::isnan(value) ? "nan" : number_text(value);
      separator = ',';
    }
  }
  return text + '\n';
}

// metrics.json: the summary of a run, for scripts.
//
// - schema_version: 1; increases when a key changes its meaning or is removed
// - frames, duration
// - metrics, by name: unit, meaning, formula, min, max, mean, final, worst_frame, worst_time,
//   worst_particle
// - run, by name, once per run: unit, meaning, formula, value
// - holds: from, to, settled_after (s)
// - checks: name, expression, value, limit, frame, pass
//
// A value is null where there was nothing to measure.

inline constexpr int metrics_schema_version = 1;

/// The whole file. `summary` is that of `frames`.
std::string metrics_json(std::span<const FrameMetrics> frames, const Summary& summary,
                         std::span<const Check> checks);

/// metrics.json of a comparison:
/// - schema_version: 1; frames, duration, remarks
/// - a, b: name, radius
/// - metrics, by name: unit, meaning, formula, a, b (min, max, mean, final each), difference (the
///   same, and largest: the one farthest from zero, with its time)
/// - run, by name: unit, meaning, formula, a, b, difference
/// - checks: as in metrics.json of a run
std::string comparison_json(const RunComparison& comparison);

}  // namespace sinew

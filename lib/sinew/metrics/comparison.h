// SPDX-License-Identifier: GPL-3.0-or-later
// Compares two runs at the times that both have: differences of all metrics, second minus first.
//
//     const RunComparison comparison = compare(std::move(first), std::move(second));
//     write_file("compare.csv", comparison_csv(comparison));
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <sinew/metrics/frame.h>
#include <sinew/metrics/limits.h>
#include <sinew/metrics/summary.h>

namespace sinew {

struct ComparedRun {
  std::string name;
  std::vector<FrameMetrics> frames;  ///< frames at the times that both have, one at least
  Summary summary;                   ///< summary of all its frames
  double radius = 0;                 ///< radius of a particle, m
  std::size_t particles = 0;
};

struct RunComparison {
  ComparedRun first, second;
  /// A metric of the second run minus that of the first; distances to the first unchanged.
  std::vector<FrameMetrics> differences;
  Summary summary;            ///< summary of the differences; run metrics are differences too
  std::vector<Check> checks;  ///< checks of the differences
  std::optional<double> speedup = {};  ///< time of the first run's steps over that of the second's
  std::vector<std::string> remarks = {};  ///< sentences on what could not be compared, and why
};

/// Whether a metric is itself a distance from a reference, of which no difference is taken.
bool is_distance(std::string_view metric);

/// The differences of two frames, as in RunComparison::differences.
FrameMetrics difference(const FrameMetrics& first, const FrameMetrics& second);

/// Computes and summarizes the differences. `first` and `second` have their frames and summaries.
RunComparison compare(ComparedRun first, ComparedRun second);

/// compare.csv: a row per time, with NAME_a, NAME_b and NAME_difference of each metric, and NAME
/// alone of distances between the runs. Numbers read back as the same bits.
std::string comparison_csv(const RunComparison& comparison);

/// The frame in which a metric's difference is farthest from zero.
std::optional<std::size_t> largest_difference(const RunComparison& comparison, std::size_t metric);

}  // namespace sinew

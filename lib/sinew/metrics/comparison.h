// SPDX-License-Identifier: GPL-3.0-or-later
// Two runs beside each other: frames of the same times, and what the second has more than the
// first.
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
  std::vector<FrameMetrics> frames;  ///< those of times that both have, one at least
  Summary summary;                   ///< of all its frames
  double radius = 0;                 ///< of a particle, m
};

struct RunComparison {
  ComparedRun first, second;
  /// A metric of the second run less that of the first; distances to the first as they are.
  std::vector<FrameMetrics> differences;
  Summary summary;                   ///< of the differences; run metrics are differences too
  std::vector<Check> checks;         ///< of the differences
  std::vector<std::string> remarks;  ///< what could not be compared, and why, in plain sentences
};

/// Whether a metric compares a frame with a reference by itself: no difference is taken of it.
bool is_distance(std::string_view metric);

/// The differences of two frames, by the rule above.
FrameMetrics difference(const FrameMetrics& first, const FrameMetrics& second);

/// Sums the differences up. `first` and `second` have their frames and summaries.
RunComparison compare(ComparedRun first, ComparedRun second);

/// compare.csv: a row per time; of each metric NAME_a, NAME_b and NAME_difference, of distances
/// between the runs NAME alone. Numbers read back as the same bits.
std::string comparison_csv(const RunComparison& comparison);

/// The frame in which a metric's difference is farthest from zero.
std::optional<std::size_t> largest_difference(const RunComparison& comparison, std::size_t metric);

}  // namespace sinew

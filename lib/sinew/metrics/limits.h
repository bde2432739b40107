// SPDX-License-Identifier: GPL-3.0-or-later
// Limits on metrics, as given with --fail-on:
//
//   volume_error > 0.05          fails if any frame is above
//   final(volume_error) > 0.05   likewise max(), min(), mean()
//   residual_rms > 0.002         metrics of the whole run
//
// Operators > >= < <= ==; limits are in the metric's unit.
//
//     const Check check = check_limit(parse_limit("volume_error > 0.05"), frames, summary);
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <sinew/metrics/frame.h>
#include <sinew/metrics/summary.h>

namespace sinew {

enum class Over { any_frame, min, max, mean, final };
enum class Comparison { above, at_least, below, at_most, equal };

struct Limit {
  std::string metric;  ///< a name of metrics_table() or run_metrics_table()
  Over over = Over::any_frame;
  Comparison comparison = Comparison::above;
  double value = 0;
};

/// Parses an expression. Throws bad input for anything but the forms above, suggesting the nearest
/// name for an unknown metric.
Limit parse_limit(std::string_view expression);

/// The result of checking a limit.
struct Check {
  std::string name;             ///< the metric's
  std::string expression;       ///< the limit in its normal form
  double value = not_measured;  ///< value compared: of any_frame the one nearest to failing
  double limit = 0;
  std::optional<std::size_t> frame;  ///< frame of the value, if it belongs to one
  bool pass = false;                 ///< the limit was kept; false where nothing was measured
};

/// Checks a run against a limit. `summary` is that of `frames`.
Check check_limit(const Limit& limit, std::span<const FrameMetrics> frames, const Summary& summary);

/// One line: "volume_error > 0.05: fails with 0.0612 in frame 31".
std::string describe(const Check& check);

}  // namespace sinew

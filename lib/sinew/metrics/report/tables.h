// SPDX-License-Identifier: GPL-3.0-or-later
// The report's tables: every metric with its numbers, meaning and formula, and the limits.
#pragma once

#include <span>
#include <string>

#include <sinew/metrics/comparison.h>
#include <sinew/metrics/frame_metrics.h>
#include <sinew/metrics/limits.h>
#include <sinew/metrics/summary.h>

namespace sinew {

/// Headings and tables; `summary` is that of `frames`.
std::string metrics_tables(std::span<const FrameMetrics> frames, const Summary& summary);

/// Heading and table: what was measured of both runs, and by how much it differs.
std::string differences_table(const RunComparison& comparison);

/// Heading and table; empty without checks.
std::string checks_table(std::span<const Check> checks);

}  // namespace sinew

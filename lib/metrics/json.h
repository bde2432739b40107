// SPDX-License-Identifier: GPL-3.0-or-later
// metrics.json: a run summed up, for scripts.
//
// - schema_version: 1; grows when a key changes its meaning or goes
// - frames, duration
// - metrics, by name: unit, meaning, formula, min, max, mean, final, worst_frame, worst_time,
//   worst_particle
// - run, by name, once per run: unit, meaning, formula, value
// - holds: from, to, settled_after (s)
// - checks: name, expression, value, limit, frame, pass
//
// null stands where there was nothing to measure.
#pragma once

#include <span>
#include <string>

#include "metrics/comparison.h"
#include "metrics/frame.h"
#include "metrics/limits.h"
#include "metrics/summary.h"

namespace sinew {

inline constexpr int metrics_schema_version = 1;

/// The whole file. `summary` is that of `frames`.
std::string metrics_json(std::span<const FrameMetrics> frames, const Summary& summary,
                         std::span<const Check> checks);

/// metrics.json of a comparison:
/// - schema_version: 1; frames, duration, remarks
/// - a, b: name, radius
/// - metrics, by name: unit, meaning, formula, a, b (min, max, mean, final each), difference (the
///   same with largest, the one farthest from zero, and its time)
/// - run, by name: unit, meaning, formula, a, b, difference
/// - checks: as in metrics.json of a run
std::string comparison_json(const RunComparison& comparison);

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// Measures two runs, compares their frames at the times that both have, and writes a report.
//
//     const RunComparison comparison = compare_runs("out/a", "out/b", {}, "out/comparison");
#pragma once

#include <filesystem>

#include <sinew/metrics/comparison.h>
#include <sinew/run/measure_run.h>

namespace sinew {

/// Writes compare.csv, metrics.json and report.html into `out`, which is created. Throws bad input
/// for folders that are not runs, for runs without a common time, and where `out` is one of them;
/// throws not written.
RunComparison compare_runs(const std::filesystem::path& first, const std::filesystem::path& second,
                           const MeasureOptions& how, const std::filesystem::path& out);

}  // namespace sinew

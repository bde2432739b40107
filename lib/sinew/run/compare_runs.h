// SPDX-License-Identifier: GPL-3.0-or-later
// Two runs measured, held against each other at the times that both have, and told of in a folder.
#pragma once

#include <filesystem>

#include <sinew/metrics/comparison.h>
#include <sinew/run/measure_run.h>

namespace sinew {

/// Writes compare.csv, metrics.json and report.html into `out`, which is made. Throws bad input for
/// folders that are no runs, for runs without a time in common, and for `out` being one of them;
/// not written.
RunComparison compare_runs(const std::filesystem::path& first, const std::filesystem::path& second,
                           const HowToMeasure& how, const std::filesystem::path& out);

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// Compares runs: the settings in which they differ; measures two, compares their frames at the
// times that both have, and writes a report.
//
//     const RunComparison comparison = compare_runs("out/a", "out/b", {}, "out/comparison");
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <sinew/metrics/comparison.h>
#include <sinew/metrics/report/report.h>
#include <sinew/run/measure_run.h>

namespace sinew {

/// A setting in which the scenes of runs differ.
struct DifferingSetting {
  std::string_view section, name;
  std::vector<std::string> values;  ///< values by scene, as scene files write them
};

/// In the order of the table of settings; lists (tracks, supports, ...) are not compared.
std::vector<DifferingSetting> differing_settings(const std::vector<const Settings*>& scenes);

/// The same by section, "0.010 → 0.014".
std::vector<FactGroup> facts_of(const std::vector<DifferingSetting>& settings);

/// Writes compare.csv, metrics.json and report.html into `out`, which is created. Throws bad input
/// for folders that are not runs, for runs without a common time, and where `out` is one of them;
/// throws not written.
RunComparison compare_runs(const std::filesystem::path& first, const std::filesystem::path& second,
                           const MeasureOptions& how, const std::filesystem::path& out);

/// The name of a run's folder, however the path is written.
std::string name_of_run(const std::filesystem::path& folder);

/// Throws bad input where `out` is one of the runs or another one: their reports would be lost.
void refuse_folders_of_runs(const std::filesystem::path& out,
                            const std::vector<std::filesystem::path>& runs);

}  // namespace sinew

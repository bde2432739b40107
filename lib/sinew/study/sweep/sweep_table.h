// SPDX-License-Identifier: GPL-3.0-or-later
// The tables of a sweep: what each run is, and what was asked of it; its last moments, its page.
//
//     write_tables(sweep, read_table(sweep));
#pragma once

#include <string>
#include <vector>

#include <sinew/study/sweep/sweep.h>

namespace sinew {

struct SweepRow {
  RunState state;
  std::vector<double> results;  ///< results asked for; not-a-number where the run lacks one
};

/// A row of each run, in the order of the sweep.
using SweepTable = std::vector<SweepRow>;

/// Reads what lies in the folders of the runs. Throws bad input for damaged tables there.
SweepTable read_table(const Sweep& sweep);

/// What was asked of a run, by its tables: metrics.csv and metrics.json, supports.csv, probes.csv.
/// The result at a time is that of the nearest frame.
std::vector<double> results_in(const std::filesystem::path& folder,
                               const std::vector<AskedResult>& asked);

/// A row of each run: the varied values as the study writes them, folder, status, reason, seconds.
std::string index_csv(const Sweep& sweep, const SweepTable& table);
/// A row of each run: the varied values, folder, and each result, "nan" where there is none.
std::string results_csv(const Sweep& sweep, const SweepTable& table);

/// Writes index.csv and results.csv. Throws not written.
void write_tables(const Sweep& sweep, const SweepTable& table);

/// Writes moments/NAME.vtu of each finished run that has frames, its particles at the last moment
/// with the varied numbers as field data, and sweep.pvd, whose times are the places of the runs in
/// the study. Where no run has frames, there is none of them. Throws not written, and bad input for
/// a damaged frame.
void write_moments(const Sweep& sweep, const SweepTable& table);

/// report.html: the runs with their results, how each result depends on what varies, and what
/// failed. The whole page, UTF-8.
std::string sweep_html(const Sweep& sweep, const SweepTable& table, const std::string& title);

}  // namespace sinew

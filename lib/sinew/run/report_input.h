// SPDX-License-Identifier: GPL-3.0-or-later
// The content of a run's report.html: its metrics, and the files in its folder.
//
//     write_file("report.html", report_html(report_input(run, std::move(measured))));
#pragma once

#include <vector>

#include <sinew/metrics/report/report.h>
#include <sinew/run/measure_run.h>
#include <sinew/run/run_files.h>

namespace sinew {

/// The forces of a scene as curves: between two particles, and of a bone on a particle.
std::vector<LawCurve> law_curves(const RunFiles& run);

enum class MovieLink { if_there, follows };  ///< follows: it is drawn after the report is written

/// Throws Error (bad input) where run.json is not the record of a run.
ReportInput report_input(const RunFiles& run, Measured measured, MovieLink movie);

// The files that measuring leaves in the folder of a run. Throw not written.

/// metrics.csv, metrics_bones.csv, sections.csv, metrics.json.
void write_tables(const RunFiles& run, const Measured& measured);
/// report.html.
void write_report(const RunFiles& run, Measured measured, MovieLink movie);

}  // namespace sinew

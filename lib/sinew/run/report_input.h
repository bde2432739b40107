// SPDX-License-Identifier: GPL-3.0-or-later
// What report.html tells of a run: its metrics, and what lies in its folder.
#pragma once

#include <vector>

#include <sinew/metrics/report/report.h>
#include <sinew/run/measure_run.h>
#include <sinew/run/run_files.h>

namespace sinew {

// The forces of a scene as curves: between two particles, and of a bone on a particle.

std::vector<Curve> law_curves(const RunFiles& run);

/// Takes what was measured. Throws Error (bad input) where the run's record is none.
ReportInput report_input(const RunFiles& run, Measured measured);

}  // namespace sinew

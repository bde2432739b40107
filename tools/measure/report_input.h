// SPDX-License-Identifier: GPL-3.0-or-later
// What report.html tells of a run: its metrics, and what lies in its folder.
#pragma once

#include "measure/measure_run.h"
#include "metrics/report/report.h"

namespace sinew {

/// Takes what was measured. Throws Error (bad input) where the run's record is none.
ReportInput report_input(const RunFiles& run, Measured measured);

}  // namespace sinew

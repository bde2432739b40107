// SPDX-License-Identifier: GPL-3.0-or-later
// What report.html tells of a run: its metrics, and what lies in its folder.
#pragma once

#include <vector>

#include "metrics/bone_metrics.h"
#include "metrics/limits.h"
#include "metrics/report/report.h"
#include "run_files.h"

namespace sinew {

struct Measured {
  std::vector<FrameMetrics> frames;
  Summary summary;
  std::vector<Check> checks;
  Film film;
  std::vector<BoneMetrics> bones;  ///< of every frame
};

/// Takes what was measured. Throws Error (bad input) where the run's record is none.
ReportInput report_input(const RunFiles& run, Measured measured);

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// The forces of a scene as curves: between two particles, and of a bone on a particle.
#pragma once

#include <vector>

#include "folder/run_files.h"
#include "metrics/report/report.h"

namespace sinew {

std::vector<Curve> law_curves(const RunFiles& run);

}  // namespace sinew

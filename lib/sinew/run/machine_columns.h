// SPDX-License-Identifier: GPL-3.0-or-later
// supports.csv and probes.csv of a run as columns over its frames, for the report.
//
//     input.machine = machine_columns("out/pull");
#pragma once

#include <filesystem>
#include <vector>

#include <sinew/metrics/report/report.h>

namespace sinew {

/// The time first, then "grip: force_z" and so on; what is nothing but rounding is left out. None
/// where a run has neither file. Of over 1200 frames, every second, third, ... Throws bad input,
/// naming the file, for a table that is damaged.
std::vector<MachineColumn> machine_columns(const std::filesystem::path& folder);

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// The tables of bones, supports and probes of a run as columns and charts over its frames, for the
// report.
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

/// Sizes of what the tables say over the same frames: forces and moments on the body, of the bones,
/// supports and loads; displacement, strain, stress and force of probes. Each chart has those with
/// the largest values; none has only trifles beside rounding. Throws as above.
std::vector<Chart> table_charts(const std::filesystem::path& folder);

}  // namespace sinew

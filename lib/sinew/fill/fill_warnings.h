// SPDX-License-Identifier: GPL-3.0-or-later
// Warnings about a filling that may not be what the user intended.
//
//     report.warnings = warnings_of(report, surface);
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <sinew/fill/fill_report.h>

namespace sinew {

/// One sentence each, with the decisive number and a cure. Examines the surface only where a part
/// of it was not filled.
std::vector<std::string> warnings_of(const FillReport& report, const Surface& surface);

/// A warning where the tetrahedra of a body hold clearly less than its `volume` (both m^3) at a
/// radius (m).
std::optional<std::string> cell_warning(double cells, double volume, double radius,
                                        const Surface& surface);

/// "1 hole", "2 holes".
std::string counted(std::size_t count, const std::string& what, const std::string& many);

/// A warning where a body of that length (m) is so large or so small that its unit may be wrong.
std::optional<std::string> size_warning(double longest);

}  // namespace sinew

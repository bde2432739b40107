// SPDX-License-Identifier: GPL-3.0-or-later
// What in a filling deserves a look.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <sinew/fill/fill_report.h>

namespace sinew {

/// One sentence each, with the number that decided and a cure. Looks at the surface only where
/// something was lost.
std::vector<std::string> warnings_of(const FillReport& report, const Surface& surface);

/// Where a body of that length (m) is so large or so small that its unit may have been mistaken.
std::optional<std::string> size_warning(double longest);

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// The report's style sheet.
#pragma once

#include <string_view>

namespace sinew {

std::string_view report_style();

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers as text, the same in every locale.
#pragma once

#include <string>

namespace sinew {

/// Shortest text that reads back as the same number.
std::string number_text(double value);

/// Three significant digits, for people: "0.00175".
std::string three_digits(double value);

}  // namespace sinew

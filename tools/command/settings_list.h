// SPDX-License-Identifier: GPL-3.0-or-later
// The table of settings as people read it.
#pragma once

#include <string>

namespace sinew {

/// A line for each key, by section, for --help.
std::string settings_help();

/// A Markdown table for each section, for the README.
std::string settings_markdown();

}  // namespace sinew

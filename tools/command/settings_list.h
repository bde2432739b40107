// SPDX-License-Identifier: GPL-3.0-or-later
// The table of settings as text: for --help and for the README files.
//
//     print_out(settings_help());
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace sinew {

/// A row of a Markdown table: "| a | b |" with a line break; bars in a cell are escaped.
inline std::string markdown_row(std::initializer_list<std::string_view> cells) {
  std::string row = "|";
  for (const std::string_view cell : cells) {
    row += ' ';
    for (const char c : cell) {
      if (c == '|') row += '\\';
      row += c;
    }
    row += " |";
  }
  return row + '\n';
}

/// A line for each key, by section, for --help.
std::string settings_help();

/// A Markdown table for each section, for configs/README.md.
std::string settings_markdown();

/// The same as a manual page, sinew-scene(5).
std::string settings_manual();

/// "body.mesh", ...: the keys that --set takes.
std::vector<std::string> setting_keys();

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of Markdown tables, for the README.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

namespace sinew {

/// "| a | b |" with a line break; bars within a cell are escaped.
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

}  // namespace sinew

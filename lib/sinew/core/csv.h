// SPDX-License-Identifier: GPL-3.0-or-later
// Tables of comma-separated values (RFC 4180).
//
//     for (const CsvRow& row : rows_of_csv(text)) use(row[0]);
#pragma once

#include <string>
#include <vector>

namespace sinew {

using CsvRow = std::vector<std::string>;

/// What follows the last line end is of a row being written, and left out.
std::vector<CsvRow> rows_of_csv(const std::string& text);

/// A text as one cell: in quotes where it contains a comma, a quote or a line end.
std::string quoted_cell(const std::string& text);

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// A CSV file that grows frame by frame, by as many rows each.
//
//     FrameTable table("out/bend/supports.csv", "time,name,force", 2);
//     table.add("0,grip,0.5\n0,clamp,-0.5\n");
//     table.close();
#pragma once

#include <filesystem>
#include <string>

#include <sinew/core/file.h>
#include <sinew/core/vector.h>

namespace sinew {

/// A text as one cell: in quotes where it contains a comma or a quote (RFC 4180), behind an
/// apostrophe where a spreadsheet would take it for a formula, or where it begins with one: readers
/// take one off.
std::string csv_cell(std::string text);

/// Appends ",x,y,z" and ",x", each as the shortest text that reads back as the same number, empty
/// where it is not-a-number.
void add_cells(const Vec3& vector, std::string& row);
void add_cell(double value, std::string& row);

class FrameTable {
 public:
  /// Continues after the first `kept` frames of an existing table with `rows` rows each. Throws not
  /// written, and bad input when it holds fewer.
  FrameTable(const std::filesystem::path& path, const std::string& columns, std::size_t rows,
             std::size_t kept = 0);

  /// The rows of one frame, each with its line end. Throws not written.
  void add(const std::string& rows) { file_.add(rows.data(), rows.size()); }
  void close() { file_.close(); }  ///< throws not written

 private:
  GrowingFile file_;
};

}  // namespace sinew

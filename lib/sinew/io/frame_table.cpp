// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/frame_table.h>

#include <cmath>
#include <string_view>

#include <sinew/core/csv.h>
#include <sinew/core/error.h>
#include <sinew/core/text.h>

namespace sinew {
namespace {

constexpr std::uint64_t largest_table = std::uint64_t{4} << 30;  // bytes

/// Bytes of the first `rows` rows including the header. Names in quotes may hold line ends.
std::uint64_t size_of_rows(const std::filesystem::path& path, std::size_t rows) {
  const std::string text = read_file(path, largest_table);
  bool quoted = false;
  std::size_t ends = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"') quoted = !quoted;
    if (text[i] == '\n' && !quoted && ++ends > rows) return i + 1;
  }
  throw bad_input(
      {path.string()},
      "has " + std::to_string(ends) + " lines where " + std::to_string(rows + 1) + " were written",
      "begin again with --force");
}

}  // namespace

std::string csv_cell(std::string text) {
  if (!text.empty() && std::string_view("=+-@\t\r'").find(text[0]) != std::string_view::npos)
    text.insert(0, 1, '\'');
  return quoted_cell(text);
}

void add_cell(double value, std::string& row) {
  row += ',';
  if (!std::isnan(value)) row += number_text(value);
}

void add_cells(const Vec3& vector, std::string& row) {
  for (const double value : vector) add_cell(value, row);
}

FrameTable::FrameTable(const std::filesystem::path& path, const std::string& columns,
                       std::size_t rows, std::size_t kept)
    : file_(path, kept > 0 ? size_of_rows(path, rows * kept) : 0) {
  if (kept == 0) add(columns + '\n');
}

}  // namespace sinew

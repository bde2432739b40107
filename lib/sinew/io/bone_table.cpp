// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/bone_table.h>

#include <string_view>

#include <sinew/core/error.h>
#include <sinew/core/text.h>

namespace sinew {
namespace {

/// In quotes where it contains a comma or a quote (RFC 4180). Behind an apostrophe where a
/// spreadsheet would take it for a formula, or where it begins with one: readers take one off.
std::string cell(std::string text) {
  if (!text.empty() && std::string_view("=+-@\t\r'").find(text[0]) != std::string_view::npos)
    text.insert(0, 1, '\'');
  if (text.find_first_of(",\"\r\n") == text.npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

void add_numbers(const BoneRow& on, std::string& row) {
  for (const Vec3& vector : {on.force, on.moment})
    for (const double value : vector) row += ',' + number_text(value);
  row += ',' + number_text(on.power);
}

std::string columns_line() {
  std::string line = "time,bone";
  for (const char* part : {"", "spring_", "pin_", "obstacle_"})
    for (const char* value :
         {"force_x", "force_y", "force_z", "moment_x", "moment_y", "moment_z", "power"})
      line += std::string(",") + part + value;
  return line + '\n';
}

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

BoneTable::BoneTable(const std::filesystem::path& path, std::size_t bones, std::size_t kept)
    : file_(path, kept > 0 ? size_of_rows(path, bones * kept) : 0) {
  const std::string columns = columns_line();
  if (kept == 0) file_.add(columns.data(), columns.size());
}

void BoneTable::add(double time, const Skeleton& skeleton, std::span<const BoneRow> sums,
                    const std::array<std::span<const BoneRow>, 3>& parts) {
  std::string rows;
  for (std::size_t b = 0; b < skeleton.size(); ++b) {
    rows += number_text(time) + ',';
    rows += cell(skeleton.bones[b].name);
    add_numbers(sums[b], rows);
    for (const auto& part : parts)
      add_numbers(part.empty() ? BoneRow{Vec3::Zero(), Vec3::Zero(), 0} : part[b], rows);
    rows += '\n';
  }
  file_.add(rows.data(), rows.size());
}

void BoneTable::close() { file_.close(); }

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/rig/key_table.h>

#include <array>
#include <charconv>
#include <cmath>
#include <map>

#include <sinew/core/csv.h>
#include <sinew/core/error.h>
#include <sinew/core/text.h>

namespace sinew {
namespace {

constexpr std::array key_columns = {"time", "bone", "qw", "qx", "qy",
                                    "qz",   "tx",   "ty", "tz", "twist"};
constexpr std::size_t with_twist = key_columns.size(), without_twist = key_columns.size() - 1;

std::string listed_columns(bool twist) {
  std::string text = key_columns.front();
  for (std::size_t k = 1; k < (twist ? with_twist : without_twist); ++k)
    (text += ',') += key_columns[k];
  return text;
}

double number_of(const CsvRow& row, std::size_t column, const Place& place) {
  const std::string& cell = row[column];
  double value = 0;
  const char* end = cell.data() + cell.size();
  const auto [stop, error] = std::from_chars(cell.data(), end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value))
    throw bad_input(
        place, std::string(key_columns[column]) + " is " + shown(cell) + ", which is no number",
        "write it as 0.25");
  return value;
}

KeyDefinition key_of(const CsvRow& row, const Place& place) {
  const auto number = [&](std::size_t column) { return number_of(row, column, place); };
  KeyDefinition key;
  key.time = number(0);
  key.quaternion = {number(2), number(3), number(4), number(5)};
  key.translation = {number(6), number(7), number(8)};
  if (row.size() == with_twist) key.twist = number(9);
  const Eigen::Vector4d quaternion(key.quaternion->data());
  constexpr double largest_rounding = 1e-3;  // bound of make_motion()
  if (!(std::abs(quaternion.norm() - 1) <= largest_rounding))
    throw bad_input(place,
                    "a quaternion of length " + number_text(quaternion.norm()) + " is no rotation",
                    "give qw, qx, qy, qz of length 1");
  return key;
}

bool is_header(const CsvRow& row) {
  if (row.size() != with_twist && row.size() != without_twist) return false;
  for (std::size_t column = 0; column < row.size(); ++column)
    if (row[column] != key_columns[column]) return false;
  return true;
}

void drop_returns(CsvRow& row) {
  if (!row.back().empty() && row.back().back() == '\r') row.back().pop_back();
}

}  // namespace

std::string key_table_header(bool twist) { return listed_columns(twist) + '\n'; }

std::string key_row(const std::string& bone, const KeyDefinition& key, bool twist) {
  std::string row = number_text(*key.time) + ',' + quoted_cell(bone);
  for (const double part : *key.quaternion) row += ',' + number_text(part);
  for (const double part : key.translation) row += ',' + number_text(part);
  return row + (twist ? ',' + number_text(key.twist) : "") + '\n';
}

std::vector<TrackDefinition> tracks_of_keys(const std::string& text, const std::string& name) {
  std::vector<CsvRow> rows = rows_of_csv(text);
  for (CsvRow& row : rows) drop_returns(row);
  if (rows.empty() || !is_header(rows.front()))
    throw bad_input({name, 1}, "this is no table of keys",
                    "begin it with " + listed_columns(false) + ", and twist where bones do");
  std::vector<TrackDefinition> tracks;
  std::map<std::string, std::size_t, std::less<>> of_bone;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const Place place{name, static_cast<int>(i) + 1};
    if (rows[i].size() != rows.front().size())
      throw bad_input(place, "a row of " + std::to_string(rows[i].size()) + " cells",
                      "give " + std::to_string(rows.front().size()) + ", as the header has");
    const auto [found, is_new] = of_bone.try_emplace(rows[i][1], tracks.size());
    if (is_new) tracks.push_back({rows[i][1], Interpolation::linear, "xyz", {}});
    std::vector<KeyDefinition>& keys = tracks[found->second].keys;
    keys.push_back(key_of(rows[i], place));
    if (keys.size() > 1 && !(*keys.back().time > *keys[keys.size() - 2].time))
      throw bad_input(place, "keys of " + shown(rows[i][1]) + " are not in ascending time",
                      "sort them, each with its own time");
  }
  return tracks;
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/run/machine_columns.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include <sinew/core/error.h>
#include <sinew/core/file.h>
#include <sinew/metrics/report/charts.h>

namespace sinew {
namespace {

constexpr std::uint64_t largest_file = std::uint64_t{1} << 30;  // bytes

using Cells = std::vector<std::string>;

/// The rows of a CSV file (RFC 4180); what follows the last line end is of a row being written.
std::vector<Cells> rows_of_csv(const std::string& text) {
  std::vector<Cells> rows;
  Cells row(1);
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"' && quoted && i + 1 < text.size() && text[i + 1] == '"') {
      row.back() += c;
      ++i;
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      row.emplace_back();
    } else if (c == '\n' && !quoted) {
      rows.push_back(std::exchange(row, Cells(1)));
    } else {
      row.back() += c;
    }
  }
  return rows;
}

std::string unit_of(std::string_view column) {
  const auto begins = [&](std::string_view start) { return column.starts_with(start); };
  if (begins("force")) return "N";
  if (begins("moment")) return "N m";
  if (begins("stress")) return "Pa";
  if (begins("strain")) return "";
  return column == "power" ? "W" : "m";
}

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& what) {
  throw bad_input(Place{file.string()}, what, "run the scene again with --force");
}

double number_in(const std::string& cell, const std::filesystem::path& file) {
  char* end = nullptr;
  const double value = std::strtod(cell.c_str(), &end);
  if (cell.empty() || *end != '\0') refuse(file, "has '" + cell + "' where a number belongs");
  return value;
}

/// The columns of one table, grouped by the name in each row, in the order of the names.
class Collector {
 public:
  explicit Collector(std::vector<MachineColumn>& all) : all_(all) {}

  void add(const std::filesystem::path& file) {
    if (!std::filesystem::exists(file)) return;
    const std::vector<Cells> rows = rows_of_csv(read_file(file, largest_file));
    if (rows.empty() || rows[0].size() < 3 || rows[0][0] != "time" ||
        (rows[0][1] != "name" && rows[0][1] != "bone"))
      refuse(file, "is no table of forces");
    for (std::size_t r = 1; r < rows.size(); ++r) {
      if (rows[r].size() != rows[0].size())
        refuse(file, "has " + std::to_string(rows[r].size()) + " cells in row " +
                         std::to_string(r + 1) + ", not " + std::to_string(rows[0].size()));
      add_row(file, rows[0], rows[r]);
    }
  }

 private:
  void add_row(const std::filesystem::path& file, const Cells& head, const Cells& row) {
    const double time = number_in(row[0], file);
    MachineColumn& times = all_.front();
    if (times.values.empty() || time > times.values.back()) times.values.push_back(time);
    for (std::size_t c = 2; c < row.size(); ++c) {
      if (head[c] == "kind" || head[c].starts_with("pivot")) continue;
      const std::string name = row[1] + ": " + head[c];
      const auto [at, fresh] = place_.try_emplace(file.filename().string() + name, all_.size());
      if (fresh) all_.push_back({name, unit_of(head[c]), {}});
      all_[at->second].values.push_back(number_in(row[c], file));
    }
  }

  std::vector<MachineColumn>& all_;
  std::map<std::string, std::size_t> place_;
};

double largest_of(const MachineColumn& column) {
  double most = 0;
  for (const double value : column.values)
    if (std::abs(value) > most) most = std::abs(value);
  return most;
}

/// Leaves out what is nothing but rounding beside other columns of its unit, and moments that are
/// rounding beside the forces.
void leave_out_rounding(std::vector<MachineColumn>& columns) {
  constexpr double rounding = 1e-10, short_arm = 0.01;  // m
  std::map<std::string, double> most;
  for (const MachineColumn& one : columns)
    most[one.unit] = std::max(most[one.unit], largest_of(one));
  most["N m"] = std::max(most["N m"], short_arm * most["N"]);
  std::erase_if(columns, [&](const MachineColumn& one) {
    return one.unit != "s" && !(largest_of(one) > rounding * most[one.unit]);
  });
}

}  // namespace

std::vector<MachineColumn> machine_columns(const std::filesystem::path& folder) {
  std::vector<MachineColumn> columns = {{"time", "s", {}}};
  Collector collector(columns);
  collector.add(folder / "supports.csv");
  collector.add(folder / "probes.csv");
  const std::size_t frames = columns.front().values.size();
  leave_out_rounding(columns);
  if (columns.size() == 1) return {};
  const std::size_t nth = frames / max_drawn + 1;
  for (MachineColumn& column : columns) {
    column.values.resize(frames, std::nan(""));
    for (std::size_t i = 0; i * nth < frames; ++i) column.values[i] = column.values[i * nth];
    column.values.resize((frames + nth - 1) / nth);
  }
  return columns;
}

namespace {

/// Lengths of the vectors whose components are columns "name: WHAT_x" and so on, by name.
std::vector<Line> sizes_of(const std::vector<MachineColumn>& columns, const std::string& what) {
  std::vector<Line> lines;
  for (std::size_t c = 0; c + 2 < columns.size(); ++c) {
    const std::string& name = columns[c].name;
    if (!name.ends_with(": " + what + "_x")) continue;
    Line line{name.substr(0, name.size() - what.size() - 4), columns[c].values};
    for (std::size_t i = 0; i < line.values.size(); ++i)
      line.values[i] =
          std::hypot(columns[c].values[i], columns[c + 1].values[i], columns[c + 2].values[i]);
    lines.push_back(std::move(line));
  }
  return lines;
}

double largest_of(const Line& line) {
  double most = 0;
  for (const double value : line.values)
    if (value > most) most = value;
  return most;
}

/// The lines with the largest values, as many as can be told apart; none of what is nothing beside
/// the largest.
std::vector<Line> largest_lines(std::vector<Line> lines) {
  constexpr std::size_t max_lines = 6;
  constexpr double nothing = 1e-3;
  std::stable_sort(lines.begin(), lines.end(),
                   [](const Line& a, const Line& b) { return largest_of(a) > largest_of(b); });
  if (lines.size() > max_lines) lines.resize(max_lines);
  const double most = lines.empty() ? 0 : largest_of(lines.front());
  std::erase_if(lines, [&](const Line& line) { return !(largest_of(line) > nothing * most); });
  return lines;
}

}  // namespace

std::vector<Chart> force_charts(const std::filesystem::path& folder) {
  struct Table {
    const char *file, *of;
  };
  std::vector<Chart> charts;
  for (const auto& [file, of] :
       {Table{"bones.csv", "bones"}, {"supports.csv", "supports and loads"}}) {
    std::vector<MachineColumn> columns = {{"time", "s", {}}};
    Collector(columns).add(folder / file);
    for (const auto& [what, unit] : {std::pair("force", "N"), std::pair("moment", "N m")}) {
      std::vector<Line> lines = largest_lines(sizes_of(columns, what));
      if (lines.empty()) continue;
      Chart chart;
      chart.title = (what == std::string("force") ? "Forces of " : "Moments of ") + std::string(of);
      chart.note = "Their sizes, on the body";
      chart.unit = unit;
      chart.lines = std::move(lines);
      charts.push_back(std::move(chart));
    }
  }
  return charts;
}

}  // namespace sinew

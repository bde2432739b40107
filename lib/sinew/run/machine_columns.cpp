// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/run/machine_columns.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include <sinew/core/csv.h>
#include <sinew/core/error.h>
#include <sinew/core/file.h>
#include <sinew/metrics/report/charts.h>

namespace sinew {
namespace {

constexpr std::uint64_t largest_file = std::uint64_t{1} << 30;  // bytes

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

/// Not-a-number in an empty cell.
double number_in(const std::string& cell, const std::filesystem::path& file) {
  if (cell.empty()) return std::nan("");
  char* end = nullptr;
  const double value = std::strtod(cell.c_str(), &end);
  if (*end != '\0') refuse(file, "has '" + cell + "' where a number belongs");
  return value;
}

/// The columns of one table, grouped by the name in each row, in the order of the names.
class Collector {
 public:
  explicit Collector(std::vector<MachineColumn>& all) : all_(all) {}

  void add(const std::filesystem::path& file) {
    if (!std::filesystem::exists(file)) return;
    const std::vector<CsvRow> rows = rows_of_csv(read_file(file, largest_file));
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
  void add_row(const std::filesystem::path& file, const CsvRow& head, const CsvRow& row) {
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

/// A quantity whose components are columns beside each other, and its size.
struct Quantity {
  const char* first;  ///< first of the components: "force_x"
  const char *title, *note, *unit;
  std::size_t components;
  double (*size)(const double*);
  Topic topic = Topic::forces;
};

double length(const double* vector) { return std::hypot(vector[0], vector[1], vector[2]); }

/// sqrt(dev T : dev T) of a tensor XX YY ZZ XY YZ XZ.
double deviator_size(const double* tensor) {
  const double mean = (tensor[0] + tensor[1] + tensor[2]) / 3;
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k)
    sum += (tensor[k] - mean) * (tensor[k] - mean) + 2 * tensor[3 + k] * tensor[3 + k];
  return std::sqrt(sum);
}

double equivalent_strain(const double* tensor) {
  return std::sqrt(2.0 / 3) * deviator_size(tensor);
}
double equivalent_stress(const double* tensor) { return std::sqrt(1.5) * deviator_size(tensor); }

/// The size of the quantity, a line for each name in the first column of the table.
std::vector<Line> sizes_of(const std::vector<MachineColumn>& columns, const Quantity& of) {
  const std::string ending = std::string(": ") + of.first;
  std::vector<Line> lines;
  for (std::size_t c = 0; c + of.components <= columns.size(); ++c) {
    const std::string& name = columns[c].name;
    if (!name.ends_with(ending)) continue;
    Line line{name.substr(0, name.size() - ending.size()), {}};
    std::array<double, 6> value{};
    for (std::size_t i = 0; i < columns[c].values.size(); ++i) {
      for (std::size_t k = 0; k < of.components; ++k) value[k] = columns[c + k].values[i];
      line.values.push_back(of.size(value.data()));
    }
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

struct Table {
  const char* file;
  std::vector<Quantity> quantities;
};

const std::vector<Table>& charted_tables() {
  constexpr const char* on_body = "Their sizes, on the body";
  static const std::vector<Table> tables{
      {"bones.csv",
       {{"force_x", "Forces of bones", on_body, "N", 3, length},
        {"moment_x", "Moments of bones", on_body, "N m", 3, length}}},
      {"supports.csv",
       {{"force_x", "Forces of supports and loads", on_body, "N", 3, length},
        {"moment_x", "Moments of supports and loads", on_body, "N m", 3, length}}},
      {"probes.csv",
       {{"displacement_x", "Displacement of probes", "Its size, from rest", "m", 3, length,
         Topic::motion},
        {"strain_xx", "Strain at probes",
         "Equivalent of the mean over the particles, sqrt(2/3 dev E : dev E)", "", 6,
         equivalent_strain, Topic::deformation},
        {"stress_xx", "Stress at probes", "Von Mises stress of the mean over the particles", "Pa",
         6, equivalent_stress},
        {"force_x", "Forces on probes", "Their sizes, of all that acts from outside", "N", 3,
         length}}}};
  return tables;
}

}  // namespace

std::vector<Chart> table_charts(const std::filesystem::path& folder) {
  constexpr double strain_span = 0.01;
  std::vector<Chart> charts;
  for (const Table& table : charted_tables()) {
    std::vector<MachineColumn> columns = {{"time", "s", {}}};
    Collector(columns).add(folder / table.file);
    for (MachineColumn& column : columns)
      column.values.resize(columns[0].values.size(), std::nan(""));
    for (const Quantity& quantity : table.quantities) {
      std::vector<Line> lines = largest_lines(sizes_of(columns, quantity));
      if (lines.empty()) continue;
      const double span = quantity.size == equivalent_strain ? strain_span : 0;
      charts.push_back({quantity.title,
                        quantity.note,
                        quantity.unit,
                        {0},
                        span,
                        Drawn::always,
                        std::move(lines),
                        quantity.topic,
                        columns[0].values});
    }
  }
  return charts;
}

}  // namespace sinew

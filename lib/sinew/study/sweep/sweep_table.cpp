// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/study/sweep/sweep_table.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <span>

#include <sinew/core/csv.h>
#include <sinew/core/file.h>
#include <sinew/core/json.h>
#include <sinew/core/text.h>
#include <sinew/metrics/table.h>
#include <sinew/run/machine_columns.h>

namespace sinew {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t largest_table = std::uint64_t{1} << 30;  // bytes

/// The values of a run over its frames, by name.
struct RunTables {
  std::map<std::string, std::vector<double>, std::less<>> metrics;
  std::vector<MachineColumn> machine;
  nlohmann::ordered_json of_run;  ///< metrics of the whole run

  explicit RunTables(const fs::path& folder) : machine(machine_columns(folder)) {
    const std::vector<CsvRow> rows = rows_of_csv(read_file(folder / "metrics.csv", largest_table));
    for (std::size_t c = 0; !rows.empty() && c < rows[0].size(); ++c)
      for (std::size_t r = 1; r < rows.size(); ++r)
        metrics[rows[0][c]].push_back(c < rows[r].size() ? std::strtod(rows[r][c].c_str(), nullptr)
                                                         : not_measured);
    const auto json =
        parsed_json<nlohmann::ordered_json>(read_file(folder / "metrics.json", largest_table));
    if (json.is_object()) of_run = json.value("run", nlohmann::ordered_json::object());
  }
};

/// The extreme one by `before(a, b)`; not-a-number where there is none.
template <class Before>
double extreme(std::span<const double> values, const Before& before) {
  double found = not_measured;
  for (const double value : values)
    if (std::isfinite(value) && (std::isnan(found) || before(value, found))) found = value;
  return found;
}

double largest_of(std::span<const double> values) {
  return extreme(values, [](double a, double b) { return std::abs(a) > std::abs(b); });
}

double worst_of(std::span<const double> values, Worse worse) {
  if (worse == Worse::larger) return extreme(values, std::greater<>());
  if (worse == Worse::smaller) return extreme(values, std::less<>());
  return largest_of(values);
}

/// The value at the time nearest to one.
double value_near(std::span<const double> times, std::span<const double> values, double time) {
  std::size_t nearest = 0;
  for (std::size_t k = 0; k < times.size(); ++k)
    if (std::abs(times[k] - time) < std::abs(times[nearest] - time)) nearest = k;
  return nearest < values.size() ? values[nearest] : not_measured;
}

double result_of(const AskedResult& asked, std::span<const double> times,
                 std::span<const double> values, Worse worse) {
  switch (asked.of) {
    case ResultOf::worst:
      return worst_of(values, worse);
    case ResultOf::largest:
      return largest_of(values);
    case ResultOf::at:
      return value_near(times, values, asked.time);
    case ResultOf::final:
      break;
  }
  return values.empty() ? not_measured : values.back();
}

double result_in(const RunTables& tables, const AskedResult& asked) {
  if (const auto found = tables.metrics.find(asked.name); found != tables.metrics.end()) {
    const std::size_t index = metric_index(asked.name);
    const Worse worse =
        index < metrics_table().size() ? metrics_table()[index].worse : Worse::magnitude;
    return result_of(asked, tables.metrics.at("time"), found->second, worse);
  }
  if (const auto of_run = tables.of_run.find(asked.name); of_run != tables.of_run.end()) {
    const auto& value = (*of_run)["value"];
    return value.is_number() ? value.get<double>() : not_measured;
  }
  for (const MachineColumn& column : tables.machine)
    if (column.name == asked.name)
      return result_of(asked, tables.machine.front().values, column.values, Worse::magnitude);
  return not_measured;
}

std::string head_of(const Sweep& sweep) {
  std::string head;
  for (const VariedKey& key : sweep.file.vary) head += quoted_cell(key.path) + ',';
  return head;
}

std::string values_in_cells(const SweepRun& run) {
  std::string cells;
  for (const std::string& value : run.values) cells += quoted_cell(value) + ',';
  return cells;
}

}  // namespace

std::vector<double> results_in(const fs::path& folder, const std::vector<AskedResult>& asked) {
  const RunTables tables(folder);
  std::vector<double> results;
  for (const AskedResult& one : asked) results.push_back(result_in(tables, one));
  return results;
}

SweepTable read_table(const Sweep& sweep) {
  SweepTable table;
  for (const SweepRun& run : sweep.runs) {
    SweepRow& row = table.emplace_back();
    row.state = state_of(sweep, run);
    row.results.assign(sweep.file.results.size(), not_measured);
    if (row.state.status == RunStatus::finished)
      row.results = results_in(sweep.folder_of(run).path, sweep.file.results);
  }
  return table;
}

std::string index_csv(const Sweep& sweep, const SweepTable& table) {
  std::string text = head_of(sweep) + "folder,status,reason,seconds\n";
  for (std::size_t k = 0; k < table.size(); ++k) {
    const RunState& state = table[k].state;
    text += values_in_cells(sweep.runs[k]) + quoted_cell("runs/" + sweep.runs[k].name) + ',' +
            std::string(word_of(state.status)) + ',' + quoted_cell(state.reason) + ',' +
            number_text(std::round(1e3 * state.seconds) / 1e3) + '\n';
  }
  return text;
}

std::string results_csv(const Sweep& sweep, const SweepTable& table) {
  std::string text = head_of(sweep) + "folder";
  for (const AskedResult& asked : sweep.file.results) text += ',' + quoted_cell(asked.title());
  text += '\n';
  for (std::size_t k = 0; k < table.size(); ++k) {
    text += values_in_cells(sweep.runs[k]) + quoted_cell("runs/" + sweep.runs[k].name);
    for (const double value : table[k].results)
      text += std::isnan(value) ? ",nan" : ',' + number_text(value);
    text += '\n';
  }
  return text;
}

void write_tables(const Sweep& sweep, const SweepTable& table) {
  create_folder(sweep.folder);
  write_file(sweep.folder / "index.csv", index_csv(sweep, table));
  write_file(sweep.folder / "results.csv", results_csv(sweep, table));
}

}  // namespace sinew

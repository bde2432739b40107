// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/study/sweep/baseline.h>

#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <sinew/core/csv.h>
#include <sinew/core/error.h>
#include <sinew/core/file.h>
#include <sinew/core/text.h>
#include <sinew/metrics/table.h>
#include <sinew/run/machine_columns.h>
#include <sinew/settings/values.h>
#include <sinew/study/sweep/sweep_table.h>

namespace sinew {
namespace {

constexpr const char* baseline_head = "name,of,value,absolute,relative";
constexpr double usual_tolerance = 1e-6;  // relative: other machines round otherwise
constexpr std::uint64_t largest_baseline = std::uint64_t{1} << 28;

using Key = std::pair<std::string, std::string>;  // name, of

/// All results of a run that it has.
std::vector<std::pair<Key, double>> results_of_run(const std::filesystem::path& run) {
  std::vector<AskedResult> asked;
  const auto ask = [&](std::string_view name, ResultOf of) {
    asked.push_back({std::string(name), of, 0, {}});
  };
  for (std::size_t k = 1; k < metrics_table().size(); ++k)
    for (const ResultOf of : {ResultOf::final, ResultOf::worst}) ask(metrics_table()[k].name, of);
  for (const RunMetric& metric : run_metrics_table()) ask(metric.name, ResultOf::worst);
  const std::vector<MachineColumn> machine = machine_columns(run);
  for (std::size_t k = 1; k < machine.size(); ++k)
    for (const ResultOf of : {ResultOf::final, ResultOf::largest}) ask(machine[k].name, of);
  const std::vector<double> values = results_in(run, asked);
  std::vector<std::pair<Key, double>> results;
  for (std::size_t k = 0; k < asked.size(); ++k)
    if (!std::isnan(values[k]))
      results.push_back(
          {{asked[k].name, std::string(result_words[static_cast<std::size_t>(asked[k].of)])},
           values[k]});
  return results;
}

struct Recorded {
  Key key;
  double value, absolute, relative;
};

/// "ignored" is any.
double tolerance_in(const std::string& cell, const Place& place) {
  if (cell == "ignored") return INFINITY;
  const auto number = parse_number(cell);
  if (!number || !(*number >= 0))
    throw bad_input(place, "'" + cell + "' is no tolerance",
                    "write a number of 0 or more, or ignored");
  return *number;
}

std::vector<Recorded> read_baseline(const std::filesystem::path& file) {
  const std::vector<CsvRow> rows = rows_of_csv(read_file(file, largest_baseline));
  const CsvRow wanted = rows_of_csv(std::string(baseline_head) + '\n').front();
  if (rows.empty() || rows[0] != wanted)
    throw bad_input(Place{file.string()}, "is no baseline",
                    "record one: sinew measure DIR --write-baseline FILE");
  std::vector<Recorded> recorded;
  for (std::size_t r = 1; r < rows.size(); ++r) {
    const Place place{file.string(), static_cast<int>(r) + 1};
    if (rows[r].size() != wanted.size())
      throw bad_input(place, "has " + std::to_string(rows[r].size()) + " cells, not 5",
                      "record it anew with --write-baseline");
    const auto value = parse_number(rows[r][2]);
    if (!value) throw bad_input(place, "'" + rows[r][2] + "' is no number", "write one, as in 0.5");
    recorded.push_back({{rows[r][0], rows[r][1]},
                        *value,
                        tolerance_in(rows[r][3], place),
                        tolerance_in(rows[r][4], place)});
  }
  return recorded;
}

}  // namespace

std::string baseline_csv(const std::filesystem::path& run) {
  std::string text = std::string(baseline_head) + '\n';
  for (const auto& [key, value] : results_of_run(run))
    text += quoted_cell(key.first) + ',' + key.second + ',' + number_text(value) + ",0," +
            number_text(usual_tolerance) + '\n';
  return text;
}

std::vector<Difference> compare_with_baseline(const std::filesystem::path& run,
                                              const std::filesystem::path& baseline) {
  const std::vector<Recorded> recorded = read_baseline(baseline);
  std::map<Key, double> now;
  std::vector<Key> order;
  for (auto& [key, value] : results_of_run(run)) now[key] = value, order.push_back(key);
  std::vector<Difference> found;
  std::set<Key> known;
  for (const auto& [key, value, absolute, relative] : recorded) {
    known.insert(key);
    const double allowed = absolute + (value == 0 ? 0 : relative * std::abs(value));
    const auto at = now.find(key);
    const double present = at == now.end() ? not_measured : at->second;
    const bool is_ignored = std::isinf(relative);
    if (!is_ignored && !(std::abs(present - value) <= allowed))
      found.push_back({key.first, key.second, value, present, allowed});
  }
  for (const Key& key : order)
    if (!known.contains(key)) found.push_back({key.first, key.second, not_measured, now[key], 0});
  return found;
}

}  // namespace sinew

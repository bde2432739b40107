// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/report/tables.h>

#include <initializer_list>
#include <vector>

#include <sinew/metrics/report/markup.h>
#include <sinew/metrics/table.h>

namespace sinew {
namespace {

struct Cell {
  std::string_view label;  ///< of its column
  std::string text;        ///< plain
};

std::string row(const std::string& first, const std::vector<Cell>& cells) {
  std::string out = element("td", first);
  for (const Cell& cell : cells)
    out += element("td", escaped(cell.text),
                   "class=\"number\" data-label=\"" + escaped(cell.label) + '"');
  return element("tr", out);
}

std::string table(std::initializer_list<std::string_view> columns, const std::string& rows) {
  std::string heads;
  for (const std::string_view column : columns)
    heads += element("th", escaped(column), heads.empty() ? "" : "class=\"number\"");
  return element("table", element("thead", element("tr", heads)) + element("tbody", rows));
}

/// Name, unit, meaning and formula of a metric.
template <class Row>
std::string described(const Row& metric) {
  const std::string unit =
      metric.unit.empty() ? "" : element("span", escaped(metric.unit), "class=\"unit\"");
  return element("code", escaped(metric.name)) + unit + element("small", escaped(metric.help)) +
         element("small", element("code", escaped(metric.formula)));
}

std::string worst_text(std::span<const FrameMetrics> frames, const MetricSummary& values) {
  if (!values.worst_frame) return "–";
  return std::to_string(*values.worst_frame) + " (" + readable(frames[*values.worst_frame].time) +
         " s)";
}

}  // namespace

std::string metrics_tables(std::span<const FrameMetrics> frames, const Summary& summary) {
  std::string rows, run_rows;
  for (std::size_t i = 0; i < metrics_table().size(); ++i) {
    const MetricSummary& values = summary.metrics[i];
    rows += row(described(metrics_table()[i]), {{"min", readable(values.min)},
                                                {"max", readable(values.max)},
                                                {"mean", readable(values.mean)},
                                                {"final", readable(values.final)},
                                                {"worst frame", worst_text(frames, values)}});
  }
  for (const RunMetric& metric : run_metrics_table())
    run_rows += row(described(metric), {{"value", readable(summary.*metric.value)}});
  return element("h2", "All metrics") +
         table({"metric", "min", "max", "mean", "final", "worst frame"}, rows) +
         element("h2", "Of the whole run") + table({"metric", "value"}, run_rows);
}

std::string differences_table(const RunComparison& compared) {
  std::string rows, run_rows;
  for (std::size_t i = 1; i < metrics_table().size(); ++i) {
    const auto largest = largest_difference(compared, i);
    if (!largest) continue;
    const Metric& metric = metrics_table()[i];
    const bool own = is_distance(metric.name);
    const FrameMetrics& at = compared.differences[*largest];
    const auto final = [&](const ComparedRun& run) {
      return own ? not_measured : run.frames.back().*metric.value;
    };
    rows += row(described(metric), {{"a, final", readable(final(compared.first))},
                                    {"b, final", readable(final(compared.second))},
                                    {"b − a, final", readable(compared.summary.metrics[i].final)},
                                    {"largest", readable(at.*metric.value)},
                                    {"at", readable(at.time) + " s"}});
  }
  for (const RunMetric& metric : run_metrics_table())
    run_rows += row(described(metric), {{"a", readable(compared.first.summary.*metric.value)},
                                        {"b", readable(compared.second.summary.*metric.value)},
                                        {"b − a", readable(compared.summary.*metric.value)}});
  return element("h2", "Differences") +
         table({"metric", "a, final", "b, final", "b − a, final", "largest", "at"}, rows) +
         element("h2", "Of the whole runs") + table({"metric", "a", "b", "b − a"}, run_rows);
}

std::string checks_table(std::span<const Check> checks) {
  if (checks.empty()) return "";
  std::string rows;
  for (const Check& check : checks) {
    const std::string verdict = element("span", check.pass ? "kept" : "fails",
                                        check.pass ? "class=\"word good\"" : "class=\"word poor\"");
    rows += row(element("code", escaped(check.expression)) + ' ' + verdict,
                {{"value", readable(check.value)},
                 {"limit", readable(check.limit)},
                 {"frame", check.frame ? std::to_string(*check.frame) : "–"}});
  }
  return element("h2", "Limits") + table({"fails when", "value", "limit", "frame"}, rows);
}

}  // namespace sinew

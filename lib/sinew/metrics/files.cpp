// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/files.h>

#include <nlohmann/json.hpp>

#include <sinew/core/json.h>
#include <sinew/metrics/table.h>

namespace sinew {

std::string metrics_csv(std::span<const FrameMetrics> frames) {
  return csv_text(metrics_table(), frames);
}

namespace {

using Json = nlohmann::ordered_json;  // keeps the tables' order; writes not-a-number as null

/// Unit, meaning and formula of a row of a table of metrics.
template <class Row>
Json json_description(const Row& row) {
  return {{"unit", row.unit}, {"meaning", row.help}, {"formula", row.formula}};
}

Json json_of(std::span<const Check> checks) {
  Json all = Json::array();
  for (const Check& check : checks)
    all.push_back({{"name", check.name},
                   {"expression", check.expression},
                   {"value", check.value},
                   {"limit", check.limit},
                   {"frame", check.frame ? Json(*check.frame) : Json()},
                   {"pass", check.pass}});
  return all;
}

Json metrics_of(std::span<const FrameMetrics> frames, const Summary& summary) {
  Json all = Json::object();
  for (std::size_t i = 0; i < metrics_table().size(); ++i) {
    const MetricSummary& values = summary.metrics[i];
    Json one = json_description(metrics_table()[i]);
    one["min"] = values.min;
    one["max"] = values.max;
    one["mean"] = values.mean;
    one["final"] = values.final;
    one["worst_frame"] = values.worst_frame ? Json(*values.worst_frame) : Json();
    one["worst_time"] = values.worst_frame ? Json(frames[*values.worst_frame].time) : Json();
    one["worst_particle"] = values.worst_particle ? Json(*values.worst_particle) : Json();
    all[std::string(metrics_table()[i].name)] = std::move(one);
  }
  return all;
}

Json run_metrics_of(const Summary& summary) {
  Json all = Json::object();
  for (const RunMetric& metric : run_metrics_table()) {
    Json one = json_description(metric);
    one["value"] = summary.*metric.value;
    all[std::string(metric.name)] = std::move(one);
  }
  return all;
}

Json holds_of(std::span<const FrameMetrics> frames, const Summary& summary) {
  Json all = Json::array();
  for (const Hold& hold : summary.holds)
    all.push_back({{"from", frames[hold.first].time},
                   {"to", frames[hold.last].time},
                   {"settled_after", hold.settled}});
  return all;
}

Json extremes(const MetricSummary& values) {
  return {{"min", values.min}, {"max", values.max}, {"mean", values.mean}, {"final", values.final}};
}

Json difference_of(const RunComparison& compared, std::size_t metric) {
  Json one = extremes(compared.summary.metrics[metric]);
  const auto largest = largest_difference(compared, metric);
  const auto value = metrics_table()[metric].value;
  one["largest"] = largest ? Json(compared.differences[*largest].*value) : Json();
  one["largest_time"] = largest ? Json(compared.differences[*largest].time) : Json();
  return one;
}

Json metrics_of(const RunComparison& compared) {
  Json all = Json::object();
  for (std::size_t i = 1; i < metrics_table().size(); ++i) {
    const Metric& metric = metrics_table()[i];
    Json one = json_description(metric);
    if (!is_distance(metric.name)) {
      one["a"] = extremes(compared.first.summary.metrics[i]);
      one["b"] = extremes(compared.second.summary.metrics[i]);
    }
    one["difference"] = difference_of(compared, i);
    all[std::string(metric.name)] = std::move(one);
  }
  return all;
}

Json run_metrics_of(const RunComparison& compared) {
  Json all = Json::object();
  for (const RunMetric& metric : run_metrics_table()) {
    Json one = json_description(metric);
    one["a"] = compared.first.summary.*metric.value;
    one["b"] = compared.second.summary.*metric.value;
    one["difference"] = compared.summary.*metric.value;
    all[std::string(metric.name)] = std::move(one);
  }
  return all;
}

Json run_of(const ComparedRun& run) { return {{"name", run.name}, {"radius", run.radius}}; }

}  // namespace

std::string metrics_json(std::span<const FrameMetrics> frames, const Summary& summary,
                         std::span<const Check> checks) {
  Json file;
  file["schema_version"] = metrics_schema_version;
  file["frames"] = summary.frames;
  file["duration"] = frames.empty() ? 0.0 : frames.back().time - frames.front().time;
  file["metrics"] = metrics_of(frames, summary);
  file["run"] = run_metrics_of(summary);
  file["holds"] = holds_of(frames, summary);
  file["checks"] = json_of(checks);
  return json_text(file, 2) + '\n';
}

std::string comparison_json(const RunComparison& compared) {
  Json file;
  file["schema_version"] = metrics_schema_version;
  file["frames"] = compared.differences.size();
  file["duration"] = compared.differences.back().time - compared.differences.front().time;
  file["remarks"] = compared.remarks;
  if (compared.speedup) file["speedup"] = *compared.speedup;
  file["a"] = run_of(compared.first);
  file["b"] = run_of(compared.second);
  file["metrics"] = metrics_of(compared);
  file["run"] = run_metrics_of(compared);
  file["checks"] = json_of(compared.checks);
  return json_text(file, 2) + '\n';
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/json.h"

#include <nlohmann/json.hpp>

#include "metrics/table.h"

namespace sinew {
namespace {

using Json = nlohmann::ordered_json;  // keeps the tables' order; writes not-a-number as null

template <class Row>
Json description(const Row& row) {
  return {{"unit", row.unit}, {"meaning", row.help}, {"formula", row.formula}};
}

Json metrics_of(std::span<const FrameMetrics> frames, const Summary& summary) {
  Json all = Json::object();
  for (std::size_t i = 0; i < metrics_table().size(); ++i) {
    const MetricSummary& values = summary.metrics[i];
    Json one = description(metrics_table()[i]);
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
    Json one = description(metric);
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

Json checks_of(std::span<const Check> checks) {
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
  file["checks"] = checks_of(checks);
  return file.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace sinew

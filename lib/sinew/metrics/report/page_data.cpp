// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/report/page_data.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include <sinew/metrics/report/charts.h>
#include <sinew/metrics/report/markup.h>
#include <sinew/metrics/table.h>

namespace sinew {
namespace {

using Json = nlohmann::ordered_json;

/// Seven digits are more than a screen can show.
Json shown(double value) {
  if (!drawable(value)) return nullptr;
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%.7g", value);
  return std::strtod(text.data(), nullptr);
}

Json points_of(const std::vector<double>& times, const std::vector<double>& values) {
  Json points = Json::array();
  for (const std::size_t i : drawn_places(values))
    points.push_back({shown(times[i]), shown(values[i])});
  return points;
}

Json charts_of(std::span<const Chart> charts) {
  Json all = Json::array();
  for (const Chart& chart : charts) {
    Json lines = Json::array();
    for (const Line& line : chart.lines)
      lines.push_back({{"name", line.name}, {"points", points_of(chart.times, line.values)}});
    all.push_back({{"title", chart.title},
                   {"unit", chart.unit},
                   {"baselines", chart.baselines},
                   {"lines", std::move(lines)}});
  }
  return all;
}

Json curves_of(const std::vector<Curve>& curves) {
  Json all = Json::array();
  for (const Curve& curve : curves) {
    Json lines = Json::array();
    for (const CurveLine& line : curve.lines)
      lines.push_back({{"name", line.name}, {"points", points_of(line.x, line.y)}});
    all.push_back({{"title", curve.title},
                   {"across", curve.across},
                   {"up", curve.up},
                   {"lines", std::move(lines)}});
  }
  return all;
}

Json worst_of(const ReportInput& input) {
  Json all = Json::array();
  for (const std::string_view name : telling_metrics()) {
    const auto frame = input.summary.metrics[metric_index(name)].worst_frame;
    if (!frame || !(std::abs(input.frames[*frame].*metrics_table()[metric_index(name)].value) > 0))
      continue;
    all.push_back({{"metric", name}, {"frame", *frame}, {"time", input.frames[*frame].time}});
  }
  return all;
}

}  // namespace

std::string page_data(const ReportInput& input, std::span<const Chart> charts) {
  Json data;
  data["charts"] = charts_of(charts);
  data["angles"] = charts.empty() ? Json::array() : points_of(charts[0].times, charts[0].angles);
  data["curves"] = curves_of(input.curves);
  data["worst"] = worst_of(input);
  std::string text = data.dump(-1, ' ', false, Json::error_handler_t::replace);
  text.pop_back();
  text += ",\"playback\":";
  text += input.playback.frames.empty() ? "null" : playback_json(input.playback);
  text += '}';
  return inert(std::move(text));
}

}  // namespace sinew

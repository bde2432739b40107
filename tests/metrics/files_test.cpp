// SPDX-License-Identifier: GPL-3.0-or-later
// metrics.csv and metrics.json read back.
#include <gtest/gtest.h>

#include <bit>
#include <nlohmann/json.hpp>
#include <sstream>

#include <sinew/metrics/files.h>
#include <sinew/metrics/table.h>
#include "metrics/world.h"

namespace sinew::test::files_test {

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, at);) parts.push_back(part);
  return parts;
}

/// Numbers that need all their digits.
std::vector<FrameMetrics> awkward_frames() {
  std::vector<FrameMetrics> frames(3);
  double value = 1.0 / 3;
  for (FrameMetrics& frame : frames)
    for (const Metric& metric : metrics_table()) frame.*metric.value = value *= -1.7;
  frames[1].J_min = 5e-324;
  frames[1].J_mean = 1.7976931348623157e308;
  frames[2].tip_angle = -not_measured;
  return frames;
}

TEST(MetricsCsv, StartsWithTheTimeAndNamesEveryMetric) {
  const auto lines = split(metrics_csv(awkward_frames()), '\n');
  const auto names = split(lines.front(), ',');
  EXPECT_EQ(names.front(), "time");
  ASSERT_EQ(names.size(), metrics_table().size());
  for (std::size_t i = 0; i < names.size(); ++i) EXPECT_EQ(names[i], metrics_table()[i].name);
}

TEST(MetricsCsv, ReadsBackToTheSameBits) {
  const auto frames = awkward_frames();
  const auto lines = split(metrics_csv(frames), '\n');
  ASSERT_EQ(lines.size(), frames.size() + 1);
  for (std::size_t row = 0; row < frames.size(); ++row) {
    const auto cells = split(lines[row + 1], ',');
    ASSERT_EQ(cells.size(), metrics_table().size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const double expected = frames[row].*metrics_table()[i].value;
      if (std::isnan(expected))
        EXPECT_EQ(cells[i], "nan");
      else
        EXPECT_EQ(std::strtod(cells[i].c_str(), nullptr), expected) << metrics_table()[i].name;
    }
  }
}

TEST(MetricsJson, ReadsBackToTheSummary) {
  const auto frames = awkward_frames();
  const Summary summary = summarize(frames, r, {{0, 1, 0.25}});
  const auto file = nlohmann::json::parse(metrics_json(frames, summary, {}));
  EXPECT_EQ(file["schema_version"], metrics_schema_version);
  EXPECT_EQ(file["frames"], 3);
  ASSERT_EQ(file["metrics"].size(), metrics_table().size());
  for (std::size_t i = 0; i < metrics_table().size(); ++i) {
    const Metric& metric = metrics_table()[i];
    const auto& one = file["metrics"][std::string(metric.name)];
    EXPECT_EQ(one["unit"], metric.unit);
    EXPECT_EQ(one["min"], summary.metrics[i].min);
    EXPECT_EQ(one["max"], summary.metrics[i].max);
    EXPECT_EQ(one["mean"], summary.metrics[i].mean);
    if (!std::isnan(summary.metrics[i].final)) {
      EXPECT_EQ(one["final"], summary.metrics[i].final);
    }
    EXPECT_EQ(one["worst_frame"], *summary.metrics[i].worst_frame);
    EXPECT_EQ(one["worst_time"], frames[*summary.metrics[i].worst_frame].time);
  }
  EXPECT_EQ(file["run"]["settling_time"]["value"], 0.25);
  EXPECT_EQ(file["holds"][0]["from"], frames[0].time);
}

TEST(MetricsJson, IsIndentedForReading) {
  const std::vector<FrameMetrics> frames(1);
  EXPECT_EQ(metrics_json(frames, summarize(frames, r), {}).substr(0, 23),
            "{\n  \"schema_version\": 1");
}

TEST(MetricsJson, SaysNullForWhatWasNotMeasured) {
  const std::vector<FrameMetrics> frames(1);
  const auto file = nlohmann::json::parse(metrics_json(frames, summarize(frames, r), {}));
  EXPECT_TRUE(file["metrics"]["J_min"]["max"].is_null());
  EXPECT_TRUE(file["metrics"]["J_min"]["worst_frame"].is_null());
  EXPECT_TRUE(file["run"]["residual_rms"]["value"].is_null());
}

TEST(MetricsJson, TellsEveryCheck) {
  const std::vector<FrameMetrics> frames(2);
  const std::vector<Check> checks{{"J_min", "J_min < 0.5", 0.25, 0.5, 1, false},
                                  {"J_mean", "mean(J_mean) < 0.5", 0.75, 0.5, {}, true}};
  const auto file = nlohmann::json::parse(metrics_json(frames, summarize(frames, r), checks));
  ASSERT_EQ(file["checks"].size(), 2u);
  EXPECT_EQ(file["checks"][0]["name"], "J_min");
  EXPECT_EQ(file["checks"][0]["value"], 0.25);
  EXPECT_EQ(file["checks"][0]["limit"], 0.5);
  EXPECT_EQ(file["checks"][0]["frame"], 1);
  EXPECT_EQ(file["checks"][0]["pass"], false);
  EXPECT_TRUE(file["checks"][1]["frame"].is_null());
  EXPECT_EQ(file["checks"][1]["pass"], true);
}

TEST(MetricsTable, DescribesEveryMetricOnceInPlainWords) {
  std::vector<std::string_view> names;
  for (const Metric& metric : metrics_table()) {
    EXPECT_FALSE(metric.help.empty() || metric.formula.empty()) << metric.name;
    EXPECT_EQ(metric.name.find_first_of(" ,;()\"\n"), metric.name.npos) << metric.name;
    names.push_back(metric.name);
  }
  for (const RunMetric& metric : run_metrics_table()) names.push_back(metric.name);
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end());
  EXPECT_EQ(sizeof(FrameMetrics), metrics_table().size() * sizeof(double));  // none left out
}

}  // namespace sinew::test::files_test

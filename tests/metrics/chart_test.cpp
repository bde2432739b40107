// SPDX-License-Identifier: GPL-3.0-or-later
// What the report's charts show: which lines, in which unit, how many points, and where gaps are.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include <sinew/metrics/report/page.h>
#include <sinew/metrics/table.h>
#include "metrics/world.h"

namespace sinew::test::chart_test {

using Json = nlohmann::json;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Without pattern, and some of them twice.
std::vector<double> some_values(std::size_t count) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i)
    values.push_back(static_cast<double>((i + 1) * 2654435761u % 1009));
  return values;
}

TEST(DrawnPlaces, AreAllOfAShortLine) {
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, max_drawn}) {
    const auto places = drawn_indices(std::vector<double>(count, 1.0));
    ASSERT_EQ(places.size(), count);
    for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(places[i], i);
  }
}

TEST(DrawnPlaces, OfALongLineAreFewInOrderAndKeepItsExtremesWhereverTheyAre) {
  for (const std::size_t count : {max_drawn + 1, 2 * max_drawn - 1, std::size_t{100'000}})
    for (const std::size_t at : {std::size_t{0}, std::size_t{1}, count / 3, count - 2, count - 1}) {
      std::vector<double> values = some_values(count);
      values[at] = 2000;
      values[count - 1 - at] = at + at + 1 == count ? 2000 : -2000;
      const auto places = drawn_indices(values);
      EXPECT_LE(places.size(), max_drawn);
      EXPECT_TRUE(std::is_sorted(places.begin(), places.end(), std::less_equal<>())) << count;
      EXPECT_TRUE(std::binary_search(places.begin(), places.end(), at)) << count << ' ' << at;
      EXPECT_TRUE(std::binary_search(places.begin(), places.end(), count - 1 - at)) << count;
    }
}

TEST(DrawnPlaces, KeepAGapAndThePeakBesideIt) {
  for (std::size_t at = 50'000; at < 50'600; ++at) {  // wherever it lies in its piece
    std::vector<double> values = some_values(100'000);
    values[at] = nan;
    values[at - 1] = values[at + 1] = 2000;
    const auto places = drawn_indices(values);
    EXPECT_LE(places.size(), max_drawn);
    ASSERT_TRUE(std::binary_search(places.begin(), places.end(), at)) << at;
    EXPECT_TRUE(std::binary_search(places.begin(), places.end(), at - 1) ||
                std::binary_search(places.begin(), places.end(), at + 1))
        << at;
  }
}

TEST(Charts, ShowMetricsOfTheTableAtMostSixAndEachPlanSome) {
  for (const ChartPlan& plan : chart_plans()) {
    EXPECT_FALSE(plan.metrics.empty()) << plan.title;
    EXPECT_LE(plan.metrics.size(), 6u) << plan.title;
    for (const auto& [name, words] : plan.metrics)
      EXPECT_LT(metric_index(name), metrics_table().size()) << name;
  }
}

TEST(Charts, TellWhatHappenedInItsOrderAndTriflesLast) {
  const auto plans = chart_plans();
  EXPECT_TRUE(std::is_sorted(
      plans.begin(), plans.end(),
      [](const ChartPlan& one, const ChartPlan& other) { return one.topic < other.topic; }));
  EXPECT_EQ(plans.front().topic, Topic::motion);
  EXPECT_EQ(plans.back().topic, Topic::numerics);
  const auto of = [](const char* title, Topic topic, double change) {
    Chart chart{title, "", "m", {0}, 1, Drawn::always, {{"line", {0, change}}}};
    chart.topic = topic;
    return chart;
  };
  std::vector<Chart> charts{of("d", Topic::numerics, 1), of("e", Topic::motion, 0.01),
                            of("b", Topic::forces, 1), of("a", Topic::deformation, 1),
                            of("c", Topic::forces, 1)};
  put_in_order(charts);
  std::string order;
  for (const Chart& chart : charts) order += chart.title;
  EXPECT_EQ(order, "abcde");
}

TEST(Charts, ShowRadiiFractionsAndChangesAsTheySay) {
  std::vector<FrameMetrics> frames(2);
  for (FrameMetrics& frame : frames)
    for (const Metric& metric : metrics_table()) frame.*metric.value = 0.5;
  frames[0].pair_energy = -7;
  frames[1].pair_energy = -5;
  frames[1].pose_error_rms = 3 * r;
  frames[1].broken_neighbors = 0.25;
  const auto last = [&](std::string_view metric, std::string_view unit) {
    for (const ChartPlan& plan : chart_plans())
      for (std::size_t k = 0; k < plan.metrics.size(); ++k)
        if (plan.metrics[k].name == metric && plan.unit == unit)
          return planned_chart(plan, frames, r).lines[k].values.back();
    return not_measured;
  };
  EXPECT_EQ(last("pair_energy", "J"), 2);
  EXPECT_EQ(last("pose_error_rms", "r"), 3);
  EXPECT_EQ(last("broken_neighbors", "%"), 25);
  EXPECT_EQ(last("J_min", ""), 0.5);
}

Chart of_lines(std::vector<Line> lines, Drawn drawn = Drawn::always) {
  return {"title", "note", "m", {0, 1}, 0, drawn, std::move(lines)};
}

TEST(Charts, SaySomethingWhereTheyChangeByMoreThanATrifle) {
  Chart chart = of_lines({{"one", {2, 2, 2}}});
  EXPECT_FALSE(says_something(chart));
  chart.lines.push_back({"other", {nan, 0, 0.4}});
  EXPECT_TRUE(says_something(chart));
  chart.span = 10;
  EXPECT_FALSE(says_something(chart));  // less than half
  chart.lines[1].values[2] = 0.5;
  EXPECT_TRUE(says_something(chart));
  EXPECT_FALSE(says_something(of_lines({{"rounding", {1, 1 + 1e-9, 1}}})));
}

TEST(Charts, LeaveOutLinesThatWereNeverMeasuredAndChartsWithoutAny) {
  std::vector<Chart> charts{
      of_lines({{"none", {nan, nan}}}),
      of_lines({{"none", {nan, INFINITY}}, {"one", {nan, 2}}, {"zero", {0, 0}}}), of_lines({})};
  leave_out_empty(charts);
  ASSERT_EQ(charts.size(), 1u);
  ASSERT_EQ(charts[0].lines.size(), 2u);
  EXPECT_EQ(charts[0].lines[0].name, "one");
  EXPECT_EQ(charts[0].lines[1].name, "zero");
}

TEST(Charts, LeaveOutWhatTheSceneHasNothingOf) {
  std::vector<Chart> charts{of_lines({{"zero", {0, nan}}, {"zero", {0, 0}}}, Drawn::unless_zero),
                            of_lines({{"zero", {0, 0}}, {"some", {0, -1e-9}}}, Drawn::unless_zero),
                            of_lines({{"zero", {0, 0}}})};
  leave_out_empty(charts);
  ASSERT_EQ(charts.size(), 2u);
  EXPECT_EQ(charts[0].lines.size(), 2u);
  EXPECT_EQ(charts[1].lines.size(), 1u);
}

TEST(PageJson, TellsAChartWithItsGapsUnitAndBaselines) {
  PageData data;
  data.times = {0, 0.5, 1, 1.5};
  data.charts = {of_lines({{"name", {1, nan, 1.0 / 3, INFINITY}}})};
  const Json chart = Json::parse(page_json(data))["charts"].at(0);
  EXPECT_EQ(chart["title"], "title");
  EXPECT_EQ(chart["note"], "note");
  EXPECT_EQ(chart["unit"], "m");
  EXPECT_EQ(chart["baselines"], Json::parse("[0, 1]"));
  EXPECT_EQ(chart["lines"][0]["name"], "name");
  EXPECT_EQ(chart["lines"][0]["points"],
            Json::parse("[[0, 1], [0.5, null], [1, 0.3333333], [1.5, null]]"));
}

TEST(PageJson, TakesAChartsOwnTimes) {
  PageData data;
  data.times = {0, 1};
  data.charts = {of_lines({{"name", {5, 6, 7}}})};
  data.charts[0].times = {0, 0.5, 1};
  const Json chart = Json::parse(page_json(data))["charts"].at(0);
  EXPECT_EQ(chart["lines"][0]["points"], Json::parse("[[0, 5], [0.5, 6], [1, 7]]"));
}

TEST(PageJson, ThinsEveryLineAndTheAngles) {
  PageData data;
  for (int i = 0; i < 100'000; ++i) data.times.push_back(0.1 * i);
  data.angles = some_values(data.times.size());
  data.charts = {of_lines({{"a", data.angles}, {"b", data.angles}})};
  const Json json = Json::parse(page_json(data));
  EXPECT_LE(json["angles"].size(), max_drawn);
  for (const Json& line : json["charts"][0]["lines"])
    EXPECT_LE(line["points"].size(), max_drawn) << line["name"];
}

TEST(PageJson, HasAnglesOnlyWhereThereAreBones) {
  PageData data;
  data.times = {0, 1, 2};
  data.angles = {0, 45, 90};
  EXPECT_EQ(Json::parse(page_json(data))["angles"], Json::parse("[[0, 0], [1, 45], [2, 90]]"));
  data.angles = {nan, nan, nan};
  EXPECT_EQ(Json::parse(page_json(data))["angles"], Json::array());
  data.angles = {0, 0.005, 0.1};  // no bend
  EXPECT_EQ(Json::parse(page_json(data))["angles"], Json::array());
}

TEST(PageJson, TellsCurvesAndWorstFrames) {
  PageData data;
  data.curves = {{"Law", "f = k x", "x in m", "f in N", {{"pair", {0, 1}, {3, -1}}}}};
  data.worst = {{"J_min", 7, 0.35}};
  const Json json = Json::parse(page_json(data));
  EXPECT_EQ(json["curves"][0]["up"], "f in N");
  EXPECT_EQ(json["curves"][0]["lines"][0]["points"], Json::parse("[[0, 3], [1, -1]]"));
  EXPECT_EQ(json["worst"], Json::parse(R"([{"metric": "J_min", "frame": 7, "time": 0.35}])"));
}

TEST(WorstFrames, AreOfferedOfWhatWentWrong) {
  std::vector<FrameMetrics> frames(3);
  frames[1].broken_neighbors = 0;
  frames[2].volume_error = 0.1;
  const auto worst = worst_frames(frames, summarize(frames, r));
  ASSERT_EQ(worst.size(), 1u);  // no neighbors are broken, and the rest was not measured
  EXPECT_EQ(worst[0].metric, "volume_error");
  EXPECT_EQ(worst[0].frame, 2u);
}

TEST(Charts, OfATestingMachineFollowTheForceThatWorks) {
  PageData data;
  data.machine = {{"time", "s", {0, 1}},
                  {"clamp: force_x", "N", {0, -20}},
                  {"hand: force_x", "N", {0, 20}},
                  {"hand: force_z", "N", {0, 5}},
                  {"hand: displacement_x", "m", {0, 0.1}},
                  {"hand: displacement_z", "m", {0, -0.3}},
                  {"roller: force_x", "N", {0, 40}},
                  {"roller: displacement_x", "m", {0, 0}}};
  const Json machine = Json::parse(page_json(data))["machine"];
  EXPECT_EQ(machine["across"], 4);
  EXPECT_EQ(machine["up"], 2);
}

TEST(Charts, OfATestingMachineBeginWithAForceOverItsDisplacement) {
  PageData data;
  EXPECT_FALSE(Json::parse(page_json(data)).contains("machine"));
  EXPECT_EQ(machine_section(data.machine), "");
  data.machine = {{"time", "s", {0, 1}},
                  {"tip: displacement_z", "m", {0, 9}},
                  {"grip: displacement_x", "m", {0, 0.1}},
                  {"grip: displacement_z", "m", {0, 0.2}},
                  {"clamp: force_z", "N", {0, -70}},
                  {"grip: force_x", "N", {0, 1}},
                  {"grip: force_z", "N", {0, NAN}},
                  {"grip: force_y", "N", {0, 2}}};
  const Json machine = Json::parse(page_json(data))["machine"];
  EXPECT_EQ(machine["columns"].size(), 8U);
  EXPECT_EQ(machine["columns"][6]["values"], Json::parse("[0, null]"));
  EXPECT_EQ(machine["across"], 2);  // along the force
  EXPECT_EQ(machine["up"], 5);
  data.machine[5].values = {1, 1};
  const Json creeps = Json::parse(page_json(data))["machine"];
  EXPECT_EQ(creeps["across"], 3);
  EXPECT_EQ(creeps["up"], 7);
  EXPECT_NE(machine_section(data.machine).find("id=\"machine\""), std::string::npos);
}

}  // namespace sinew::test::chart_test

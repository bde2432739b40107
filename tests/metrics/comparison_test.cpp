// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/comparison.h>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include <sinew/metrics/files.h>
#include <sinew/metrics/report/comparison_page.h>
#include <sinew/metrics/table.h>
#include "metrics/world.h"

namespace sinew::test::comparison_test {

ComparedRun some_run(const char* name, double factor) {
  ComparedRun run{name, std::vector<FrameMetrics>(3), {}, r, 1000};
  for (int i = 0; i < 3; ++i) {
    for (const Metric& metric : metrics_table()) run.frames[i].*metric.value = factor * (i + 1);
    run.frames[i].time = 0.5 * i;
  }
  run.summary = summarize(run.frames, r);
  return run;
}

RunComparison some_comparison() { return compare(some_run("paper", 1), some_run("bonded", 3)); }

TEST(Comparison, TakesTheFirstFromTheSecondAndLeavesDistancesAsTheyAre) {
  const RunComparison compared = some_comparison();
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(compared.differences[i].time, 0.5 * i);
    EXPECT_EQ(compared.differences[i].volume, 2 * (i + 1));
    EXPECT_EQ(compared.differences[i].reference_hausdorff, 3 * (i + 1));
  }
  EXPECT_EQ(compared.summary.metrics[metric_index("volume")].final, 6);
}

TEST(ComparisonJson, LastsAsLongAsTheFramesThatBothHave) {
  ComparedRun first = some_run("a", 1), second = some_run("b", 2);
  first.frames.erase(first.frames.begin());
  second.frames.erase(second.frames.begin());
  const auto file = nlohmann::json::parse(comparison_json(compare(first, second)));
  EXPECT_EQ(file["duration"], 0.5);
}

TEST(Comparison, OfARunWithItselfIsNothing) {
  const RunComparison compared = compare(some_run("a", 2), some_run("a", 2));
  for (const Metric& metric : metrics_table().subspan(1))
    for (const FrameMetrics& frame : compared.differences)
      if (!is_distance(metric.name)) {
        EXPECT_EQ(frame.*metric.value, 0) << metric.name;
      }
}

TEST(Comparison, RunMetricsAreDifferencesToo) {
  ComparedRun first = some_run("a", 1), second = some_run("b", 1);
  first.summary.settling_time = 0.5;
  second.summary.settling_time = 0.2;
  const RunComparison compared = compare(first, second);
  EXPECT_NEAR(compared.summary.settling_time, -0.3, 1e-15);
  EXPECT_TRUE(std::isnan(compared.summary.residual_rms));  // never measured
}

TEST(Comparison, LimitsAreOnDifferences) {
  const RunComparison compared = some_comparison();
  const auto check = [&](const char* limit) {
    return check_limit(parse_limit(limit), compared.differences, compared.summary);
  };
  EXPECT_FALSE(check("volume > 5.9").pass);
  EXPECT_TRUE(check("volume > 6").pass);
  EXPECT_FALSE(check("max(reference_hausdorff) > 8").pass);
}

TEST(Comparison, FindsTheLargestDifferenceWhicheverItsSign) {
  ComparedRun first = some_run("a", 1), second = some_run("b", 1);
  second.frames[0].J_min -= 0.5;
  second.frames[2].J_min += 0.25;
  const std::size_t J = metric_index("J_min");
  EXPECT_EQ(largest_difference(compare(first, second), J), 0u);
  for (FrameMetrics& frame : second.frames) frame.J_min = not_measured;
  EXPECT_FALSE(largest_difference(compare(first, second), J));
}

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, at);) parts.push_back(part);
  return parts;
}

TEST(ComparisonCsv, HasBothRunsAndTheirDifferenceInEveryRow) {
  const auto lines = split(comparison_csv(some_comparison()), '\n');
  ASSERT_EQ(lines.size(), 4u);
  const auto names = split(lines[0], ','), values = split(lines[3], ',');
  ASSERT_EQ(names.size(), values.size());
  EXPECT_EQ(names[0], "time");
  const auto value = [&](const char* name) {
    const auto found = std::find(names.begin(), names.end(), name);
    EXPECT_NE(found, names.end()) << name;
    return std::stod(values.at(static_cast<std::size_t>(found - names.begin())));
  };
  EXPECT_EQ(value("time"), 1);
  EXPECT_EQ(value("volume_a"), 3);
  EXPECT_EQ(value("volume_b"), 9);
  EXPECT_EQ(value("volume_difference"), 6);
  EXPECT_EQ(value("reference_hausdorff"), 9);
}

TEST(ComparisonJson, TellsBothRunsTheirDifferenceAndItsLargest) {
  RunComparison compared = some_comparison();
  compared.remarks = {"Something else."};
  const auto file = nlohmann::json::parse(comparison_json(compared));
  EXPECT_EQ(file["frames"], 3);
  EXPECT_EQ(file["a"]["name"], "paper");
  EXPECT_EQ(file["b"]["name"], "bonded");
  EXPECT_EQ(file["remarks"][0], "Something else.");
  const auto& volume = file["metrics"]["volume"];
  EXPECT_EQ(volume["unit"], "m^3");
  EXPECT_EQ(volume["a"]["final"], 3);
  EXPECT_EQ(volume["b"]["final"], 9);
  EXPECT_EQ(volume["difference"]["largest"], 6);
  EXPECT_EQ(volume["difference"]["largest_time"], 1);
  EXPECT_FALSE(file["metrics"]["reference_hausdorff"].contains("a"));
  EXPECT_TRUE(file["run"]["residual_rms"]["difference"].is_null());
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != text.npos;
}

TEST(ComparisonPage, ShowsBothVerdictsDifferencesRemarksAndSettings) {
  ComparisonInput input{"1.2.3", some_comparison(), {}, {}, "body: one\n", "body: other\n"};
  input.comparison.remarks = {"The particles are not the same."};
  input.facts = {{"material", {{"model", "paper → bonded"}}}};
  const std::string page = comparison_html(input);
  for (const char* part :
       {"<h1>paper and bonded</h1>", "a: paper</h2>", "b: bonded</h2>", "The particles are not",
        "paper → bonded", "body: one", "body: other", "Differences</h2>", "compare.csv"})
    EXPECT_TRUE(contains(page, part)) << part;
  for (const Metric& metric : metrics_table().subspan(1)) {
    std::string cell = ">";
    cell += metric.name;
    EXPECT_TRUE(contains(page, cell += '<')) << metric.name;
  }
}

TEST(ComparisonPage, EscapesNamesAndRemarks) {
  const std::string evil = "</script><script>alert('x')</script>";
  ComparisonInput input{evil, compare(some_run(evil.c_str(), 1), some_run(evil.c_str(), 2)),
                        {},   {{evil, {{evil, evil}}}},
                        evil, evil};
  input.comparison.remarks = {evil};
  EXPECT_FALSE(contains(comparison_html(input), "<script>alert"));
}

Playback playback_of(const RestBody& body) {
  Playback playback = plan_playback(body, 2, 0.5);
  for (const std::size_t frame : {0, 1}) {
    const FrameState state =
        moved_rigidly(body, turned(30.0 * double(frame), {0, 1, 0}), {0, 0, 0});
    add_frame(playback, frame, body, state, particle_values(body, state));
  }
  return playback;
}

TEST(SideBySide, PutsTheSecondBesideTheFirstAndKeepsBothWhole) {
  const RestBody body = rest_body(box_input());
  const Playback one = playback_of(body), both = side_by_side(one, one, {"a: ", "b: "});
  const std::size_t n = one.particles.size();
  ASSERT_EQ(both.frames.size(), 2u);
  EXPECT_EQ(both.particles.size(), 2 * n);
  EXPECT_EQ(both.bone_names, (std::vector<std::string>{"lower", "upper", "lower", "upper"}));
  EXPECT_EQ(both.bone_color, (std::vector<int>{0, 1, 0, 1}));
  EXPECT_EQ(both.bone[n], one.bone[0] + 2);
  for (const PlaybackFrame& frame : both.frames) {
    ASSERT_EQ(frame.particles.size(), 6 * n);
    const float way = frame.particles[3 * n] - frame.particles[0];
    for (std::size_t i = 0; i < n; ++i) {
      EXPECT_NEAR(frame.particles[3 * (n + i)] - frame.particles[3 * i], way, 1e-6);
      EXPECT_EQ(frame.particles[3 * (n + i) + 2], frame.particles[3 * i + 2]);
    }
    float first_end = -1e9f, second_begin = 1e9f;
    for (std::size_t i = 0; i < n; ++i) {
      first_end = std::max(first_end, frame.particles[3 * i]);
      second_begin = std::min(second_begin, frame.particles[3 * (n + i)]);
    }
    EXPECT_GT(second_begin, first_end);
    for (const auto& values : frame.values)
      if (!values.empty()) {
        EXPECT_EQ(values.size(), 2 * n);
      }
  }
}

TEST(SideBySide, ColorsBonesByTheirNames) {
  const Playback one = playback_of(rest_body(box_input()));
  Playback other = one;
  other.bone_names = {"hand", "lower"};
  const Playback both = side_by_side(one, other, {"a: ", "b: "});
  EXPECT_EQ(both.bone_names, (std::vector<std::string>{"lower", "a: upper", "b: hand", "lower"}));
  EXPECT_EQ(both.bone_color, (std::vector<int>{0, 1, 2, 0}));
}

TEST(SideBySide, ColorsBothByOneScaleThatHoldsBoth) {
  Playback one = playback_of(rest_body(box_input())), other = one;
  const std::size_t n = one.particles.size();
  other.particles.resize(1);  // a thousandth of all: not outermost for all that
  other.bone.resize(1);
  other.balls.front().count = 1;
  for (PlaybackFrame& frame : one.frames) frame.values[0].assign(n, 0.25F);
  for (PlaybackFrame& frame : other.frames) {
    frame.values.assign(playback_fields().size(), {7.0F});
    frame.particles.resize(3);
  }
  const auto json = nlohmann::json::parse(playback_json(side_by_side(one, other, {"a: ", "b: "})));
  const auto& displacement = json["fields"][0];
  EXPECT_EQ(displacement["name"], "displacement");
  EXPECT_EQ(displacement["low"], 0.25);
  EXPECT_EQ(displacement["high"], 7);
}

TEST(SideBySide, DrawsBothWithBallsOfTheirOwnSize) {
  const Playback one = playback_of(rest_body(box_input()));
  Playback other = one;
  other.balls.front().radius /= 3;
  const Playback both = side_by_side(one, other, {"a: ", "b: "});
  ASSERT_EQ(both.balls.size(), 2u);
  EXPECT_EQ(both.balls[0].radius, r);
  EXPECT_EQ(both.balls[1].radius, r / 3);
  EXPECT_EQ(both.balls[1].count, other.particles.size());
}

TEST(SideBySide, AFieldThatOnlyOneHasIsNoneForTheOther) {
  const RestBody without = rest_body(box_input());
  RestInput input = box_input();
  static const ForceLaw law =
      law_without_bonds([](const Material&, double d) { return 2 * r - d; });
  obey(input, law);
  const Playback both =
      side_by_side(playback_of(without), playback_of(rest_body(input)), {"a: ", "b: "});
  const auto& stress = both.frames[0].values[4];
  ASSERT_EQ(stress.size(), 2 * without.particles());
  EXPECT_TRUE(std::isnan(stress.front()));
  EXPECT_FALSE(std::isnan(stress.back()));
}

}  // namespace sinew::test::comparison_test

// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/report/report.h>

#include <gtest/gtest.h>
#include <algorithm>

#include <nlohmann/json.hpp>

#include <sinew/core/error.h>
#include <sinew/metrics/report/page.h>
#include <sinew/metrics/summary.h>
#include <sinew/metrics/table.h>
#include "metrics/world.h"

namespace sinew::test::report_test {

/// A motion of `count` frames in which every metric has a value.
std::vector<FrameMetrics> some_frames(int count) {
  std::vector<FrameMetrics> frames(count);
  for (int i = 0; i < count; ++i)
    for (const Metric& metric : metrics_table()) frames[i].*metric.value = 0.01 * i;
  return frames;
}

ReportInput some_report(int frames = 5) {
  ReportInput input;
  input.title = "a scene";
  input.version = "1.2.3";
  input.radius = r;
  input.facts = {{"Run", {{"particles", "2965"}}}};
  input.frames = some_frames(frames);
  input.summary = summarize(input.frames, r);
  return input;
}

Playback some_playback() {
  const RestBody body = rest_body(box_input());
  Playback playback = plan_playback(body, 1);
  add_frame(playback, 0, body, at_rest(body), particle_values(body, at_rest(body)));
  return playback;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != text.npos;
}

TEST(Report, NamesEveryMetricWithItsMeaning) {
  const std::string page = report_html(some_report());
  for (const Metric& metric : metrics_table()) {
    EXPECT_TRUE(contains(page, ">" + std::string(metric.name) + "<")) << metric.name;
    EXPECT_TRUE(contains(page, std::string(metric.help.substr(0, 10)))) << metric.name;
  }
  for (const RunMetric& metric : run_metrics_table())
    EXPECT_TRUE(contains(page, ">" + std::string(metric.name) + "<")) << metric.name;
}

/// The page without the libraries, which name addresses in their comments.
std::string own_part(std::string page) {
  for (const std::string_view library : {chart_library(), scene_library()})
    page.erase(page.find(library), library.size());
  return page;
}

TEST(Report, NeedsNothingFromTheNetwork) {
  ReportInput input = some_report();
  input.movie = "https://example.org/movie.mp4";
  input.pictures = {{"//example.org/a.png", "one"}, {"javascript:alert(1)", "two"}};
  const std::string page = own_part(report_html(input));
  for (const char* outside :
       {"http:", "https:", "=\"//", "javascript:", "@import", "url(", "<link", "fetch(", "src=\"/"})
    EXPECT_FALSE(contains(page, outside)) << outside;
  EXPECT_TRUE(contains(page, "default-src 'none'"));
}

TEST(Report, CarriesItsLibrariesWithTheirLicenses) {
  const std::string page = report_html(some_report());
  for (const char* part : {"Chart.js v3", "OrbitControls", "Chart.js contributors",
                           "three.js authors", "Permission is hereby granted"})
    EXPECT_TRUE(contains(page, part)) << part;
}

TEST(Report, EscapesWhateverItIsGiven) {
  const std::string evil = "</script><script>alert('x')</script>\"&";
  ReportInput input = some_report();
  input.title = input.version = input.movie = input.scene_text = evil;
  input.facts = {{evil, {{evil, evil}}}};
  input.pictures = {{evil, evil}};
  input.checks = {{evil, evil, 1, 2, {}, false}};
  input.curves = {{evil, evil, evil, evil, {{evil, {0, 1}, {0, 1}}}}};
  input.playback = some_playback();
  input.playback.bone_names = {evil};
  const std::string page = own_part(report_html(input));
  EXPECT_FALSE(contains(page, "<script>alert"));
  EXPECT_TRUE(contains(page, "&lt;script&gt;alert(&#39;x&#39;)&lt;/script&gt;&quot;&amp;"));
  EXPECT_TRUE(contains(page, "\\u003cscript>alert('x')"));
}

TEST(Report, ShowsFactsPicturesMovieChecksAndScene) {
  ReportInput input = some_report();
  input.pictures = {{"pictures/at rest.png", "At rest"}};
  input.movie = "pictures/movie.mp4";
  input.checks = {{"J_min", "J_min < 0.5", 0.25, 0.5, 3, false}};
  input.scene_text = "body:\n  mesh: box.obj\n";
  const std::string page = report_html(input);
  for (const char* part : {"<h1>a scene</h1>", "<dt>particles</dt>", "<dd>2965</dd>",
                           "src=\"pictures/at%20rest.png\"", "src=\"pictures/movie.mp4\"",
                           "<video controls", "J_min &lt; 0.5", "mesh: box.obj", "sinew 1.2.3"})
    EXPECT_TRUE(contains(page, part)) << part;
}

/// What the page's script reads from the element of that id.
nlohmann::json json_in(const std::string& page, const std::string& id) {
  const std::string begin = "<script type=\"application/json\" id=\"" + id + "\">";
  const std::size_t at = page.find(begin);
  if (at == page.npos) return nullptr;
  const std::size_t from = at + begin.size();
  return nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
}

TEST(Report, HandsEveryPlannedChartAndItsCurvesToTheScript) {
  ReportInput input = some_report();
  input.frames.back().bone_angle = 30;
  input.curves = {{"Law", "", "x", "y", {{"pair", {0, 1}, {3, -1}}}}};
  const std::string page = report_html(input);
  const auto data = json_in(page, "data");
  ASSERT_EQ(data["charts"].size(), chart_plans().size());
  for (const ChartPlan& plan : chart_plans()) {
    const auto& charts = data["charts"];
    const auto chart = std::find_if(charts.begin(), charts.end(),
                                    [&](const auto& one) { return one["title"] == plan.title; });
    ASSERT_NE(chart, charts.end()) << plan.title;
    EXPECT_EQ((*chart)["lines"].size(), plan.metrics.size());
    EXPECT_EQ((*chart)["lines"][0]["points"].size(), input.frames.size());
  }
  EXPECT_TRUE(std::is_sorted(
      data["charts"].begin(), data["charts"].end(), [](const auto& a, const auto& b) {
        return a["folded"].template get<bool>() < b["folded"].template get<bool>();
      }));
  EXPECT_EQ(data["angles"].size(), input.frames.size());
  EXPECT_EQ(data["curves"].size(), 1u);
  EXPECT_TRUE(contains(page, "id=\"charts\"") && contains(page, "id=\"curves\""));
}

/// The chart of that title.
nlohmann::json chart_in(const std::string& page, const std::string& title) {
  const nlohmann::json data = json_in(page, "data");
  for (const auto& chart : data["charts"])
    if (chart["title"] == title) return chart;
  return nullptr;
}

/// A body of 1 MPa: forces that strain no particle by a thousandth, and a residual of a
/// thousandth of the energies.
TEST(Report, FoldsAwayWhatIsATrifleBesideTheMaterial) {
  ReportInput input = some_report();
  input.modulus = 1e6;
  const double force = 0.01 * input.modulus * 4 * r * r;
  const auto forces = [&](double size) {
    Chart chart{"Forces", "", "N", {0}, 0, Drawn::always, {{"bone", {0, 0, size, 0, 0}}}};
    input.charts = {chart};
    return chart_in(report_html(input), "Forces");
  };
  EXPECT_TRUE(forces(0.04 * force)["folded"]);
  EXPECT_FALSE(forces(0.06 * force)["folded"]);
  for (std::size_t i = 0; i < input.frames.size(); ++i) {
    input.frames[i].pair_energy = static_cast<double>(i);
    input.frames[i].energy_residual = 0.001 * static_cast<double>(i);
  }
  EXPECT_TRUE(chart_in(report_html(input), "Balance of energies")["folded"]);
  input.frames.back().energy_residual = 0.1;
  EXPECT_FALSE(chart_in(report_html(input), "Balance of energies")["folded"]);
}

TEST(Report, HasAPlaybackOnlyWhereThereAreFrames) {
  ReportInput input = some_report();
  EXPECT_TRUE(json_in(report_html(input), "playback").is_null());
  EXPECT_FALSE(contains(report_html(input), "id=\"stage\""));
  input.playback = some_playback();
  EXPECT_EQ(json_in(report_html(input), "playback")["snapshots"].size(), 1u);
  EXPECT_TRUE(contains(report_html(input), "id=\"stage\""));
}

TEST(Report, SaysWithoutJavaScriptWhereTheNumbersAre) {
  const std::string page = report_html(some_report());
  const std::size_t begin = page.find("<noscript>"), end = page.find("</noscript>");
  ASSERT_LT(begin, end);
  const std::string line = page.substr(begin, end - begin);
  for (const char* part : {"JavaScript", "3D view", "metrics.csv"})
    EXPECT_TRUE(contains(line, part)) << part;
}

TEST(Report, StandsWithOneFrameAndNothingMeasured) {
  ReportInput input = some_report(1);
  EXPECT_TRUE(contains(report_html(input), "</html>"));
  input.frames = {FrameMetrics{}};
  input.frames[0].time = 0;
  input.summary = summarize(input.frames, r);
  const std::string page = report_html(input);
  EXPECT_FALSE(contains(own_part(page), "not measured"));  // no cards of what has no meaning
  EXPECT_FALSE(contains(own_part(page), "nan"));
  input.frames.clear();
  EXPECT_THROW(report_html(input), Error);
}

TEST(Report, StaysSmallHoweverLongTheRun) {
  EXPECT_LT(own_part(report_html(some_report(50000))).size(), 2u << 20);
}

TEST(Verdict, SaysInWordsWhatTheWorstFramesAre) {
  std::vector<FrameMetrics> frames = some_frames(3);
  frames[1].volume_error = 0.01;
  frames[2].volume_error = 0;
  frames[1].pose_error_far_rms = 3 * r;
  frames[1].inverted = 100;
  frames[1].broken_neighbors = 0.02;
  frames[2].broken_neighbors = 0;
  Summary summary = summarize(frames, r);
  summary.residual_rms = 0.1 * r;
  const auto items = verdict(frames, summary, r, 1000);
  EXPECT_EQ(items[0].value, "1.00 %");
  EXPECT_EQ(items[0].level, Level::good);
  EXPECT_EQ(items[1].value, "3.00 r");
  EXPECT_EQ(items[1].level, Level::fair);
  EXPECT_EQ(items[2].value, "2.00 %");
  EXPECT_EQ(items[2].level, Level::fair);
  EXPECT_EQ(items[3].value, "10.00 %");
  EXPECT_EQ(items[3].level, Level::poor);
  EXPECT_EQ(items[4].label, "residual after the return, rms and maximum");
  EXPECT_EQ(items[4].value, "0.10 r, 2.0 r at most");
}

TEST(Verdict, GivesReasonsForDistrust) {
  std::vector<FrameMetrics> frames = some_frames(3);
  for (FrameMetrics& frame : frames)
    frame.volume_error = frame.pose_error_far_rms = frame.inverted = 0;
  const auto reasons = [&] { return reasons_for_distrust(frames, summarize(frames, r), r, 1000); };
  EXPECT_EQ(reasons(), "");
  frames[1].inverted = 10;  // a hundredth
  EXPECT_EQ(reasons(), "");
  frames[1].inverted = 11;
  EXPECT_EQ(reasons(), "11 of 1000 particles are inverted");
  frames[2].volume_error = 0.5;
  frames[0].pose_error_far_rms = 7 * r;
  EXPECT_EQ(reasons(),
            "11 of 1000 particles are inverted, the volume is off by 50.00 %, the body is 7.00 r "
            "from the pose of its bones");
}

TEST(Verdict, CountsBondsWhereThereAreSome) {
  std::vector<FrameMetrics> frames(1);
  frames[0].broken_neighbors = 1;
  EXPECT_EQ(verdict(frames, summarize(frames, r), r, 1000)[2].label, "broken neighbors");
  frames[0].broken_bonds = 0.005;
  const VerdictItem item = verdict(frames, summarize(frames, r), r, 1000)[2];
  EXPECT_EQ(item.label, "broken bonds");
  EXPECT_EQ(item.value, "0.50 %");
  EXPECT_EQ(item.level, Level::good);
}

TEST(Verdict, JudgesEachLimbByItsOwnBoneWhereThereIsNoReturn) {
  std::vector<FrameMetrics> frames(1);
  frames[0].tip_angle = 3;  // of a bone that does not turn, beside one that does
  frames[0].bone_angle = 90;
  frames[0].limb_turn_max = 6;
  const VerdictItem item = verdict(frames, summarize(frames, r), r, 1000)[4];
  EXPECT_EQ(item.label, "between a limb and its bone, at the end");
  EXPECT_EQ(item.value, "6.0°");
  EXPECT_EQ(item.level, Level::fair);
  EXPECT_EQ(verdict(frames, summarize(frames, r), r, 1000)[0].level, Level::unknown);
}

TEST(Verdict, EachScaleChangesAtItsTwoValues) {
  struct Judged {
    double FrameMetrics::*metric;
    int item;
    double good, fair;
  };
  constexpr double above = 1 + 1e-9;
  const auto level = [](const Judged& judged, double value) {
    std::vector<FrameMetrics> frames(1);
    frames[0].bone_angle = 0;
    frames[0].*judged.metric = value;
    return verdict(frames, summarize(frames, 1), 1, 1000)[static_cast<std::size_t>(judged.item)]
        .level;
  };
  for (const Judged& judged : {Judged{&FrameMetrics::volume_error, 0, 0.02, 0.1},
                               Judged{&FrameMetrics::pose_error_far_rms, 1, 2, 5},
                               Judged{&FrameMetrics::broken_neighbors, 2, 0.01, 0.05},
                               Judged{&FrameMetrics::inverted, 3, 1, 10},  // of a thousand
                               Judged{&FrameMetrics::limb_turn_max, 4, 5, 20}}) {
    EXPECT_EQ(level(judged, judged.good), Level::good) << judged.item;
    EXPECT_EQ(level(judged, judged.good * above + 1e-9), Level::fair) << judged.item;
    EXPECT_EQ(level(judged, judged.fair), Level::fair) << judged.item;
    EXPECT_EQ(level(judged, judged.fair * above), Level::poor) << judged.item;
  }
}

TEST(Verdict, CallsABodyFrozenThatItsBonesDoNotMove) {
  std::vector<FrameMetrics> frames(2);
  for (FrameMetrics& frame : frames)
    frame.bone_angle = 40, frame.displacement_max = 0.3 * r, frame.work_of_world = 0;
  Summary summary = summarize(frames, r);
  summary.residual_rms = 0;  // which a body has that never moved
  EXPECT_EQ(verdict(frames, summary, r, 1000)[4].meaning, "frozen: its bones move nothing");
  EXPECT_EQ(verdict(frames, summary, r, 1000)[4].level, Level::poor);
  frames[1].work_of_world = 1e-9;  // a machine that strains it by little
  EXPECT_EQ(verdict(frames, summary, r, 1000)[4].level, Level::good);
  frames[1].work_of_world = not_measured;  // of a static run, whose loads strain it by little
  EXPECT_EQ(verdict(frames, summary, r, 1000)[4].level, Level::good);
  frames[1].work_of_world = 0, frames[1].gravity_energy = -1e-6;  // it sags a little
  EXPECT_EQ(verdict(frames, summary, r, 1000)[4].level, Level::good);
  frames[1].gravity_energy = 0;
  EXPECT_EQ(verdict(frames, summary, r, 1000)[4].level, Level::poor);
  frames[0].displacement_max = 1.1 * r;
  EXPECT_EQ(verdict(frames, summary, r, 1000)[4].level, Level::good);
  for (FrameMetrics& frame : frames) frame.displacement_max = 0, frame.bone_angle = not_measured;
  EXPECT_EQ(verdict(frames, summary, r, 1000)[4].level, Level::good);  // no bone that could
}

TEST(Report, OpensWithHowARunBrokeOff) {
  ReportInput input = some_report(3);
  EXPECT_EQ(report_html(input).find("role=\"alert\""), std::string::npos);
  input.end = {RunEnd::Kind::broke, 0.3, 1.2, "step 7: particle 5 on bone <Hips>; use a shorter"};
  const std::string page = report_html(input);
  const std::size_t band = page.find("class=\"band broke\"");
  ASSERT_NE(band, std::string::npos);
  EXPECT_LT(band, page.find("<h1>"));
  EXPECT_NE(page.find("particle 5 on bone &lt;Hips&gt;"), std::string::npos);
  EXPECT_NE(page.find("broke off after 0.3 s of 1.2 s"), std::string::npos);
}

TEST(Verdict, ScalesTheResidualToo) {
  const std::vector<FrameMetrics> frames(1);
  Summary summary = summarize(frames, 1);
  for (const auto& [residual, level] : {std::pair{0.2, Level::good},
                                        {0.21, Level::fair},
                                        {1.0, Level::fair},
                                        {1.01, Level::poor}}) {
    summary.residual_rms = residual * r;
    EXPECT_EQ(verdict(frames, summary, r, 1000)[4].level, level) << residual;
  }
}

}  // namespace sinew::test::report_test

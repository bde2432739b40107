// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/report/report.h>

#include <algorithm>

#include <sinew/core/error.h>
#include <sinew/metrics/markup.h>
#include <sinew/metrics/report/charts.h>
#include <sinew/metrics/report/page.h>

namespace sinew {
namespace {

std::string header(const ReportInput& input) {
  const auto& frames = input.frames;
  const std::string line = std::to_string(frames.size()) + " frames from " +
                           readable(frames.front().time) + " s to " + readable(frames.back().time) +
                           " s. One r is the radius of a particle, " + readable(input.radius) +
                           " m.";
  return element("header", element("h1", escaped(input.title)) +
                               (input.subject.empty() ? "" : element("p", escaped(input.subject))) +
                               element("p", line, "class=\"quiet\""));
}

std::string pictures(const ReportInput& input) {
  std::string figures;
  if (!input.movie.empty())
    figures +=
        element("figure",
                "<video controls preload=\"metadata\" onerror=\"this.parentNode.hidden "
                "= true\" src=\"" +
                    link_to(input.movie) + "\"></video>" + element("figcaption", "The whole run"));
  for (const Picture& picture : input.pictures)
    figures += element("figure", "<img loading=\"lazy\" src=\"" + link_to(picture.path) +
                                     "\" alt=\"" + escaped(picture.caption) + "\">" +
                                     element("figcaption", escaped(picture.caption)));
  if (figures.empty()) return "";
  return element("h2", "Pictures") + element("div", figures, "class=\"pictures\"");
}

/// Span of a scale of this unit at least: what strains a particle by a hundredth,
/// or moves it by half its radius. 0 where nothing is known.
double min_span(const ReportInput& input, std::string_view unit) {
  constexpr double strain = 0.01;
  const double width = 2 * input.radius, stress = strain * input.modulus;
  const double duration = input.frames.back().time - input.frames.front().time;
  if (unit == "Pa") return stress;
  if (unit == "N") return stress * width * width;
  if (unit == "N m") return stress * width * width * width;
  if (unit == "J") return strain * stress * width * width * width / 2;
  if (unit == "m") return width / 4;
  return unit == "m/s" && duration > 0 ? width / 4 / duration : 0;
}

/// Makes trifles look like trifles, and a residual as small as it is beside the energies.
void bound_scales(const ReportInput& input, std::vector<Chart>& charts) {
  constexpr double noticed = 0.1;
  double energy = 0;
  for (const Chart& chart : charts)
    if (chart.unit == "J" && chart.topic != Topic::numerics)
      energy = std::max(energy, largest_change(chart));
  for (Chart& chart : charts) {
    if (chart.span > 0) continue;
    chart.span = min_span(input, chart.unit);
    if (chart.unit == "J" && chart.topic == Topic::numerics)
      chart.span = std::max(chart.span, noticed * energy);
  }
}

PageData drawn_data(const ReportInput& input) {
  PageData data;
  for (const FrameMetrics& frame : input.frames) {
    data.times.push_back(frame.time);
    data.angles.push_back(frame.bone_angle);
  }
  for (const ChartPlan& plan : chart_plans())
    data.charts.push_back(planned_chart(plan, input.frames, input.radius));
  data.charts.insert(data.charts.end(), input.charts.begin(), input.charts.end());
  leave_out_empty(data.charts);
  bound_scales(input, data.charts);
  put_in_order(data.charts);
  data.curves = input.curves;
  data.worst = worst_frames(input.frames, input.summary);
  data.machine = input.machine;
  return data;
}

/// What the 3D view leaves out of the run.
std::string thinned_text(const Playback& playback) {
  const auto fraction = [](std::size_t kept, std::size_t all, const char* what) {
    return kept == all ? "all " + std::to_string(all) + what
                       : std::to_string(kept) + " of " + std::to_string(all) + what;
  };
  return "Shown: " + fraction(playback.particles.size(), playback.run_particles, " particles, ") +
         fraction(playback.frames.size(), playback.run_frames, " frames, ") +
         fraction(playback.points.size(), playback.run_points, " points of the surface.");
}

std::string playback_section(const ReportInput& input) {
  if (input.playback.frames.empty()) return "";
  return element("section",
                 element("h2", "In space") + view_section("Worst frame of") +
                     element("p", thinned_text(input.playback), "class=\"quiet\""),
                 "class=\"needs-script\"");
}

std::string worst_text(std::span<const FrameMetrics> frames, const MetricSummary& values) {
  if (!values.worst_frame) return "–";
  return std::to_string(*values.worst_frame) + " (" + readable(frames[*values.worst_frame].time) +
         " s)";
}

/// Every metric with its numbers, meaning and formula.
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
  return unfolded("All metrics",
                  table({"metric", "min", "max", "mean", "final", "worst frame"}, rows)) +
         unfolded("Metrics of the whole run", table({"metric", "value"}, run_rows));
}

}  // namespace

std::string report_html(const ReportInput& input) {
  if (input.frames.empty())
    throw bad_input("a report needs a frame at least", "measure a run that has written frames");
  const std::string body =
      end_band(input.end) + header(input) + remarks(input.warnings) +
      verdict_cards(input.frames, input.summary, input.radius, input.particles) +
      checks_table(input.checks) + playback_section(input) + pictures(input) +
      machine_section(input.machine) + charts_section(!input.playback.frames.empty()) +
      curves_section("The force laws of this scene", input.curves) +
      metrics_tables(input.frames, input.summary) + element("h2", "What was run") +
      fact_lists(input.facts) + folded("The resolved scene", input.scene_text);
  return page_html(
      {input.title, input.version, body, "metrics.csv", drawn_data(input), input.playback});
}

}  // namespace sinew

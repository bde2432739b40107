// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/report/report.h>

#include <sinew/core/error.h>
#include <sinew/metrics/report/charts.h>
#include <sinew/metrics/report/markup.h>
#include <sinew/metrics/report/page.h>
#include <sinew/metrics/report/page_data.h>
#include <sinew/metrics/report/tables.h>

namespace sinew {
namespace {

std::string header(const ReportInput& input) {
  const auto& frames = input.frames;
  const std::string line = std::to_string(frames.size()) + " frames from " +
                           readable(frames.front().time) + " s to " + readable(frames.back().time) +
                           " s. One r is the radius of a particle, " + readable(input.radius) +
                           " m.";
  return element("header",
                 element("h1", escaped(input.title)) + element("p", line, "class=\"quiet\""));
}

std::string pictures(const ReportInput& input) {
  std::string figures;
  if (!input.movie.empty())
    figures +=
        element("figure", "<video controls preload=\"metadata\" src=\"" + link_to(input.movie) +
                              "\"></video>" + element("figcaption", "The whole run"));
  for (const Picture& picture : input.pictures)
    figures += element("figure", "<img loading=\"lazy\" src=\"" + link_to(picture.path) +
                                     "\" alt=\"" + escaped(picture.caption) + "\">" +
                                     element("figcaption", escaped(picture.caption)));
  if (figures.empty()) return "";
  return element("h2", "Pictures") + element("div", figures, "class=\"pictures\"");
}

std::vector<Chart> filled_charts(const ReportInput& input) {
  std::vector<Chart> charts;
  for (const ChartPlan& plan : chart_plans())
    if (is_drawn(plan, input.frames))
      charts.push_back(planned_chart(plan, input.frames, input.radius));
  return charts;
}

/// What of the run the 3D view leaves out.
std::string thinned_text(const Playback& playback) {
  const auto share = [](std::size_t kept, std::size_t all, const char* what) {
    return kept == all ? "all " + std::to_string(all) + what
                       : std::to_string(kept) + " of " + std::to_string(all) + what;
  };
  return "Shown: " + share(playback.particles.size(), playback.run_particles, " particles, ") +
         share(playback.frames.size(), playback.run_frames, " frames, ") +
         share(playback.points.size(), playback.run_points, " points of the surface.");
}

std::string playback_section(const ReportInput& input) {
  if (input.playback.frames.empty()) return "";
  return element("h2", "In space") + view_section("Worst frame of") +
         element("p", thinned_text(input.playback), "class=\"quiet\"");
}

std::string curves_section(const ReportInput& input) {
  std::string figures;
  for (const Curve& curve : input.curves)
    figures += element("figure",
                       element("figcaption", element("h3", escaped(curve.title)) +
                                                 element("p", escaped(curve.note))) +
                           element("noscript", "Drawn where scripts may run."),
                       "class=\"curve\"");
  if (figures.empty()) return "";
  return element("h2", "The laws with this scene's numbers") +
         element("div", figures, "class=\"charts\"");
}

}  // namespace

std::string report_html(const ReportInput& input) {
  if (input.frames.empty())
    throw bad_input("a report needs a frame at least", "measure a run that has written frames");
  const std::vector<Chart> charts = filled_charts(input);
  const std::string body =
      header(input) + verdict_cards(input.frames, input.summary, input.radius) +
      checks_table(input.checks) + playback_section(input) + pictures(input) +
      charts_section(charts, !input.playback.frames.empty()) + curves_section(input) +
      metrics_tables(input.frames, input.summary) + element("h2", "What was run") +
      fact_lists(input.facts) + folded("The resolved scene", input.scene_text);
  return page_html({input.title, input.version, body,
                    "The same numbers, frame by frame, are in metrics.csv, and summed up in "
                    "metrics.json.",
                    page_data(input, charts)});
}

}  // namespace sinew

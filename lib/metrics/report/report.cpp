// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/report/report.h"

#include <cmath>

#include "core/error.h"
#include "metrics/report/charts.h"
#include "metrics/report/embedded.h"
#include "metrics/report/markup.h"
#include "metrics/report/page_data.h"
#include "metrics/report/tables.h"
#include "metrics/verdict.h"

namespace sinew {
namespace {

// The browser itself holds the page to this: no request to anywhere but for the pictures beside it.
constexpr std::string_view only_this_file =
    "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
    "img-src 'self' file: data:; media-src 'self' file:; style-src 'unsafe-inline'; "
    "script-src 'unsafe-inline'\">\n";

constexpr std::string_view charts_hint =
    "<p class=\"quiet needs-script\">Drag across a chart to see a part of the time, double-click "
    "for all of it, click to go there in the 3D view.</p>";

const char* name_of(Level level) {
  switch (level) {
    case Level::good:
      return "good";
    case Level::fair:
      return "fair";
    case Level::poor:
      return "poor";
    case Level::unknown:
      return "unknown";
  }
  return "unknown";
}

std::string header(const ReportInput& input) {
  const auto& frames = input.frames;
  const std::string line = std::to_string(frames.size()) + " frames from " +
                           readable(frames.front().time) + " s to " + readable(frames.back().time) +
                           " s. One r is the radius of a particle, " + readable(input.radius) +
                           " m.";
  return element("header",
                 element("h1", escaped(input.title)) + element("p", line, "class=\"quiet\""));
}

std::string verdict_cards(const ReportInput& input) {
  std::string cards;
  for (const VerdictItem& item : verdict(input.frames, input.summary, input.radius)) {
    const std::string kind = std::string("class=\"word ") + name_of(item.level) + '"';
    cards += element("div",
                     element("b", escaped(item.value)) +
                         element("span", escaped(item.label), "class=\"label\"") +
                         element("span", escaped(item.meaning), kind),
                     "class=\"card\"");
  }
  return element("section", cards, "class=\"cards\" aria-label=\"Verdict\"");
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
    charts.push_back(planned_chart(plan, input.frames, input.radius));
  return charts;
}

std::string charts_section(const std::vector<Chart>& charts) {
  std::string figures;
  for (const Chart& chart : charts) figures += chart_html(chart);
  return element("h2", "Over time") + std::string(charts_hint) +
         element("div", figures, "class=\"charts\"");
}

/// What of the run the 3D view leaves out.
std::string thinned_text(const Film& film) {
  const auto share = [](std::size_t kept, std::size_t all, const char* what) {
    return kept == all ? "all " + std::to_string(all) + what
                       : std::to_string(kept) + " of " + std::to_string(all) + what;
  };
  return "Shown: " + share(film.particles.size(), film.run_particles, " particles, ") +
         share(film.frames.size(), film.run_frames, " frames, ") +
         share(film.points.size(), film.run_points, " points of the surface.");
}

std::string film_section(const ReportInput& input) {
  if (input.film.frames.empty()) return "";
  return element("h2", "In space") + std::string(view_markup()) +
         element("p", thinned_text(input.film), "class=\"quiet\"");
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

std::string facts(const ReportInput& input) {
  std::string groups;
  for (const FactGroup& group : input.facts) {
    std::string rows;
    for (const Fact& fact : group.facts)
      rows += element("dt", escaped(fact.name)) + element("dd", escaped(fact.value));
    groups += element("section", element("h3", escaped(group.title)) + element("dl", rows));
  }
  std::string out = element("h2", "What was run");
  if (!groups.empty()) out += element("div", groups, "class=\"facts\"");
  if (!input.scene_text.empty())
    out += element("details", element("summary", "The resolved scene") +
                                  element("pre", escaped(input.scene_text)));
  return out;
}

std::string scripts(const ReportInput& input, const std::vector<Chart>& charts) {
  const std::string data =
      element("script", page_data(input, charts), "type=\"application/json\" id=\"data\"");
  return data + element("script", std::string(chart_library())) +
         element("script", std::string(scene_library())) +
         element("script", std::string(page_script()));
}

std::string head(const ReportInput& input) {
  return "<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n" +
         std::string(only_this_file) + element("title", escaped(input.title) + " – sinew") +
         element("style", std::string(page_style()));
}

std::string footer(const ReportInput& input) {
  return element("footer",
                 element("p", "Written by sinew " + escaped(input.version) +
                                  ". The same numbers, frame by frame, are in metrics.csv, and "
                                  "summed up in metrics.json.") +
                     element("details", element("summary", "Licences of what draws this page") +
                                            element("pre", escaped(licences()))));
}

}  // namespace

std::string report_html(const ReportInput& input) {
  if (input.frames.empty())
    throw bad_input("a report needs a frame at least", "measure a run that has written frames");
  const std::vector<Chart> charts = filled_charts(input);
  const std::string body = header(input) + verdict_cards(input) + checks_table(input.checks) +
                           film_section(input) + pictures(input) + charts_section(charts) +
                           curves_section(input) + metrics_tables(input.frames, input.summary) +
                           facts(input) + footer(input) + scripts(input, charts);
  return "<!DOCTYPE html>\n" +
         element("html", '\n' + element("head", '\n' + head(input)) + element("body", '\n' + body),
                 "lang=\"en\"");
}

}  // namespace sinew

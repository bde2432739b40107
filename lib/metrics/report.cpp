// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/report.h"

#include <cmath>

#include "core/error.h"
#include "metrics/markup.h"
#include "metrics/report_charts.h"
#include "metrics/report_style.h"
#include "metrics/report_tables.h"
#include "metrics/verdict.h"

namespace sinew {
namespace {

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

std::string charts(const ReportInput& input) {
  std::string figures;
  for (const ChartPlan& plan : chart_plans())
    figures += chart_html(planned_chart(plan, input.frames, input.radius));
  return element("h2", "Over time") + element("div", figures, "class=\"charts\"");
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

}  // namespace

std::string report_html(const ReportInput& input) {
  if (input.frames.empty())
    throw bad_input("a report needs a frame at least", "measure a run that has written frames");
  const std::string head =
      "<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n" +
      element("title", escaped(input.title) + " – sinew") +
      element("style", std::string(report_style()));
  const std::string body =
      header(input) + verdict_cards(input) + checks_table(input.checks) + pictures(input) +
      charts(input) + metrics_tables(input.frames, input.summary) + facts(input) +
      element("footer", "Written by sinew " + escaped(input.version) +
                            ". The same numbers, frame by frame, are in metrics.csv, and summed "
                            "up in metrics.json.");
  return "<!DOCTYPE html>\n" +
         element("html", '\n' + element("head", '\n' + head) + element("body", '\n' + body),
                 "lang=\"en\"");
}

}  // namespace sinew

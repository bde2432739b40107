// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/report/page.h>

#include <sinew/metrics/report/embedded.h>
#include <sinew/metrics/report/markup.h>
#include <sinew/metrics/summary.h>

namespace sinew {
namespace {

// The browser itself holds the page to this: no request to anywhere but for the pictures beside it.
constexpr std::string_view only_this_file =
    "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
    "img-src 'self' file: data:; media-src 'self' file:; style-src 'unsafe-inline'; "
    "script-src 'unsafe-inline'\">\n";

constexpr std::string_view charts_hint =
    "Drag across a chart to see a part of the time, double-click for all of it";

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

std::string scripts(const Page& page) {
  const std::string data = element("script", page.data, "type=\"application/json\" id=\"data\"");
  return data + element("script", std::string(chart_library())) +
         element("script", std::string(scene_library())) +
         element("script", std::string(page_script()));
}

std::string head(const Page& page) {
  return "<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n" +
         std::string(only_this_file) + element("title", escaped(page.title) + " – sinew") +
         element("style", std::string(page_style()));
}

std::string footer(const Page& page) {
  return element(
      "footer",
      element("p", "Written by sinew " + escaped(page.version) + ". " + escaped(page.ending)) +
          element("details", element("summary", "Licenses of what draws this page") +
                                 element("pre", escaped(licenses()))));
}

}  // namespace

std::string page_html(const Page& page) {
  return "<!DOCTYPE html>\n" +
         element("html",
                 '\n' + element("head", '\n' + head(page)) +
                     element("body", '\n' + page.body + footer(page) + scripts(page)),
                 "lang=\"en\"");
}

std::string verdict_cards(std::span<const FrameMetrics> frames, const Summary& summary,
                          double radius) {
  std::string cards;
  for (const VerdictItem& item : verdict(frames, summary, radius)) {
    const std::string kind = std::string("class=\"word ") + name_of(item.level) + '"';
    cards += element("div",
                     element("b", escaped(item.value)) +
                         element("span", escaped(item.label), "class=\"label\"") +
                         element("span", escaped(item.meaning), kind),
                     "class=\"card\"");
  }
  return element("section", cards, "class=\"cards\" aria-label=\"Verdict\"");
}

std::string charts_section(const std::vector<Chart>& charts, bool with_view) {
  std::string figures;
  for (const Chart& chart : charts) figures += chart_html(chart);
  const std::string hint =
      std::string(charts_hint) + (with_view ? ", click to go there in the 3D view." : ".");
  return element("h2", "Over time") + element("p", hint, "class=\"quiet needs-script\"") +
         element("div", figures, "class=\"charts\"");
}

std::string fact_lists(const std::vector<FactGroup>& all) {
  std::string groups;
  for (const FactGroup& group : all) {
    std::string rows;
    for (const Fact& fact : group.facts)
      rows += element("dt", escaped(fact.name)) + element("dd", escaped(fact.value));
    groups += element("section", element("h3", escaped(group.title)) + element("dl", rows));
  }
  return groups.empty() ? "" : element("div", groups, "class=\"facts\"");
}

std::string folded(const std::string& title, const std::string& text) {
  if (text.empty()) return "";
  return element("details", element("summary", escaped(title)) + element("pre", escaped(text)));
}

std::string view_section(std::string_view worst) {
  constexpr std::string_view place = "{worst}";
  std::string markup(view_markup());
  return markup.replace(markup.find(place), place.size(), worst);
}

}  // namespace sinew

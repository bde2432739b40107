// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/report/page.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>

#include <sinew/core/json.h>
#include <sinew/metrics/markup.h>
#include <sinew/metrics/summary.h>

namespace sinew {
namespace {

using Json = nlohmann::ordered_json;

/// Seven digits exceed the resolution of a screen.
Json shown(double value) {
  if (!drawable(value)) return nullptr;
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%.7g", value);
  return std::strtod(text.data(), nullptr);
}

Json points_of(const std::vector<double>& across, const std::vector<double>& up) {
  Json points = Json::array();
  for (const std::size_t i : drawn_indices(up)) points.push_back({shown(across[i]), shown(up[i])});
  return points;
}

Json json_of(const Chart& chart, const std::vector<double>& of_frames) {
  const std::vector<double>& times = chart.times.empty() ? of_frames : chart.times;
  Json lines = Json::array();
  for (const Line& line : chart.lines)
    lines.push_back({{"name", line.name}, {"points", points_of(times, line.values)}});
  return {{"title", chart.title},         {"note", chart.note}, {"unit", chart.unit},
          {"baselines", chart.baselines}, {"span", chart.span}, {"folded", !says_something(chart)},
          {"lines", std::move(lines)}};
}

Json json_of(const LawCurve& curve) {
  Json lines = Json::array();
  for (const CurveLine& line : curve.lines)
    lines.push_back({{"name", line.name}, {"points", points_of(line.x, line.y)}});
  return {{"title", curve.title},
          {"note", curve.note},
          {"across", curve.across},
          {"up", curve.up},
          {"lines", std::move(lines)}};
}

double range_of(const MachineColumn& column) {
  double low = 0, high = 0;
  bool any = false;
  for (const double value : column.values) {
    if (!drawable(value)) continue;
    low = any ? std::min(low, value) : value;
    high = any ? std::max(high, value) : value;
    any = true;
  }
  return high - low;
}

std::string owner_of(const MachineColumn& column) {
  return column.name.substr(0, column.name.rfind(':') + 1);
}

/// The column with the largest range of those that are wanted; `otherwise` where none changes.
template <class Wanted>
std::size_t widest(const std::vector<MachineColumn>& columns, std::size_t otherwise,
                   const Wanted& wanted) {
  double most = 0;
  for (std::size_t k = 0; k < columns.size(); ++k)
    if (wanted(columns[k]) && range_of(columns[k]) > most) {
      most = range_of(columns[k]);
      otherwise = k;
    }
  return otherwise;
}

/// Two columns of a chart.
struct Pair {
  std::size_t across = 0, up = 0;
};

/// A force over the displacement along it, of what does most work: that of a load or a support that
/// moves something. None where no force changes.
std::optional<Pair> along_a_force(const std::vector<MachineColumn>& columns) {
  std::optional<Pair> best;
  double most = 0;
  for (std::size_t up = 0; up < columns.size(); ++up) {
    const std::string owner = owner_of(columns[up]), &name = columns[up].name;
    if (!name.substr(owner.size()).starts_with(" force_")) continue;
    for (std::size_t across = 0; across < columns.size(); ++across) {
      if (columns[across].name != owner + " displacement_" + name.back()) continue;
      const double work = range_of(columns[up]) * range_of(columns[across]);
      if (work > most) best = Pair{across, up};
      most = std::max(most, work);
    }
  }
  return best;
}

/// Finds the displacement and the force that change most, of the same owner where one has both.
Pair widest_pair(const std::vector<MachineColumn>& columns) {
  const auto has_force = [&](const std::string& owner) {
    return std::any_of(columns.begin(), columns.end(), [&](const MachineColumn& one) {
      return one.unit == "N" && owner_of(one) == owner;
    });
  };
  Pair pair;
  pair.across = widest(columns, 0, [&](const MachineColumn& one) {
    return one.name.find(": displacement_") != std::string::npos && has_force(owner_of(one));
  });
  pair.up = widest(columns, columns.size() - 1, [&](const MachineColumn& one) {
    return one.unit == "N" && (pair.across == 0 || owner_of(one) == owner_of(columns[pair.across]));
  });
  return pair;
}

Json machine_json(const std::vector<MachineColumn>& columns) {
  Json all = Json::array();
  for (const MachineColumn& column : columns) {
    Json values = Json::array();
    for (const double value : column.values) values.push_back(shown(value));
    all.push_back({{"name", column.name}, {"unit", column.unit}, {"values", std::move(values)}});
  }
  const std::optional<Pair> along = along_a_force(columns);
  const Pair first = along ? *along : widest_pair(columns);
  return {{"columns", std::move(all)}, {"across", first.across}, {"up", first.up}};
}

/// Whether there are bones, and one bends noticeably.
bool has_bend(const std::vector<double>& angles) {
  constexpr double noticed = 0.25;  // degrees
  return std::all_of(angles.begin(), angles.end(), [](double angle) { return angle >= 0; }) &&
         std::any_of(angles.begin(), angles.end(), [](double angle) { return angle >= noticed; });
}

// The browser enforces this: no requests except for the pictures beside the page.
constexpr std::string_view only_this_file =
    "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
    "img-src 'self' file: data:; media-src 'self' file:; style-src 'unsafe-inline'; "
    "script-src 'unsafe-inline'\">\n";

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

std::string json_script(const std::string& id, std::string json) {
  return element("script", inert(std::move(json)), "type=\"application/json\" id=\"" + id + '"');
}

std::string scripts(const Page& page) {
  const std::string playback =
      page.playback.frames.empty() ? "" : json_script("playback", playback_json(page.playback));
  return json_script("data", page_json(page.data)) + playback +
         element("script", std::string(chart_library())) +
         element("script", std::string(scene_library())) +
         element("script", std::string(view_script()) + std::string(page_script()));
}

std::string head(const Page& page) {
  return "<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n" +
         std::string(only_this_file) + element("title", escaped(page.title) + " – sinew") +
         element("style", std::string(page_style()));
}

std::string without_script(const Page& page) {
  const std::string line =
      "The charts and the 3D view need JavaScript; the numbers they show are in " + page.table;
  return element("noscript", element("p", escaped(line) + '.'));
}

std::string footer(const Page& page) {
  const std::string sources = !page.sources.empty()
                                  ? page.sources
                                  : "The same numbers, frame by frame, are in " + page.table +
                                        "; metrics.json has their summary.";
  return element("footer",
                 element("p", escaped("Written by sinew " + page.version + ". " + sources)) +
                     folded("Licenses of the libraries in this page", std::string(licenses())));
}

/// Name, unit, meaning and formula.
template <class Row>
std::string description(const Row& metric) {
  const std::string unit =
      metric.unit.empty() ? "" : element("span", escaped(metric.unit), "class=\"unit\"");
  return element("code", escaped(metric.name)) + unit + element("small", escaped(metric.help)) +
         element("small", element("code", escaped(metric.formula)));
}

}  // namespace

std::string page_json(const PageData& data) {
  Json json{{"charts", Json::array()}, {"curves", Json::array()}, {"worst", Json::array()}};
  for (const Chart& chart : data.charts) json["charts"].push_back(json_of(chart, data.times));
  for (const LawCurve& curve : data.curves) json["curves"].push_back(json_of(curve));
  for (const auto& [metric, frame, time] : data.worst)
    json["worst"].push_back({{"metric", metric}, {"frame", frame}, {"time", time}});
  if (!data.machine.empty()) json["machine"] = machine_json(data.machine);
  json["angles"] = has_bend(data.angles) ? points_of(data.times, data.angles) : Json::array();
  return json_text(json);
}

std::vector<WorstFrame> worst_frames(std::span<const FrameMetrics> frames, const Summary& worst) {
  std::vector<WorstFrame> all;
  for (const std::string_view name : headline_metrics()) {
    const std::size_t metric = metric_index(name);
    const auto frame = worst.metrics[metric].worst_frame;
    if (frame && std::abs(frames[*frame].*metrics_table()[metric].value) > 0)
      all.push_back({name, *frame, frames[*frame].time});
  }
  return all;
}

std::string page_html(const Page& page) {
  return "<!DOCTYPE html>\n" + element("html",
                                       '\n' + element("head", '\n' + head(page)) +
                                           element("body", '\n' + without_script(page) + page.body +
                                                               footer(page) + scripts(page)),
                                       "lang=\"en\"");
}

std::string end_band(const RunEnd& end) {
  if (end.kind == RunEnd::Kind::finished) return "";
  const bool broke = end.kind == RunEnd::Kind::broke;
  const std::string times = readable(end.time) + " s of " + readable(end.of) + " s";
  const std::string what =
      broke ? "This run broke off after " + times + ": what follows is of the frames before."
            : "This run has come to " + times + '.';
  return element("section", element("b", what) + element("p", escaped(end.why)),
                 std::string("role=\"alert\" class=\"band ") + (broke ? "broke" : "waits") + '"');
}

std::string verdict_cards(std::span<const FrameMetrics> frames, const Summary& summary,
                          double radius, std::size_t particles) {
  std::string cards;
  for (const VerdictItem& item : verdict(frames, summary, radius, particles)) {
    if (item.level == Level::unknown) continue;  // a body without bones has no pose to follow
    const std::string kind = std::string("class=\"word ") + name_of(item.level) + '"';
    cards += element("div",
                     element("b", escaped(item.value)) +
                         element("span", escaped(item.label), "class=\"label\"") +
                         element("span", escaped(item.meaning), kind),
                     "class=\"card\"");
  }
  return element("section", cards, "class=\"cards\" aria-label=\"Verdict\"");
}

std::string remarks(const std::vector<std::string>& sentences) {
  std::string items;
  for (const std::string& sentence : sentences) items += element("li", escaped(sentence));
  return items.empty() ? "" : element("ul", items, "class=\"remarks\"");
}

std::string checks_table(std::span<const Check> checks) {
  if (checks.empty()) return "";
  std::string rows;
  for (const Check& check : checks) {
    const std::string verdict = element("span", check.pass ? "kept" : "fails",
                                        check.pass ? "class=\"word good\"" : "class=\"word poor\"");
    rows += row(element("code", escaped(check.expression)) + ' ' + verdict,
                {{"value", readable(check.value)},
                 {"limit", readable(check.limit)},
                 {"frame", check.frame ? std::to_string(*check.frame) : "–"}});
  }
  return element("h2", "Limits") + table({"fails when", "value", "limit", "frame"}, rows);
}

std::string described(const Metric& metric) { return description(metric); }

std::string described(const RunMetric& metric) { return description(metric); }

std::string curves_section(const std::string& title, const std::vector<LawCurve>& curves,
                           const std::string& hint) {
  if (curves.empty()) return "";
  return element("section",
                 element("h2", title) +
                     (hint.empty() ? "" : element("p", hint, "class=\"quiet hint\"")) +
                     element("div", "", "class=\"charts\" id=\"curves\""),
                 "class=\"needs-script\"");
}

std::string charts_section(bool with_view) {
  std::string hint =
      "Drag across a chart to see a part of the time, double-click for all of it, click a name to "
      "hide its line";
  hint += with_view ? "; click a chart to show that time in the 3D view." : ".";
  return element("section",
                 element("h2", "Over time") + element("p", hint, "class=\"quiet hint\"") +
                     element("div", "", "class=\"charts\" id=\"charts\"") +
                     element("details",
                             element("summary", "What hardly changed") +
                                 element("div", "", "class=\"charts\" id=\"quiet-charts\""),
                             "id=\"quiet\" hidden"),
                 "class=\"needs-script\"");
}

std::string machine_section(std::span<const MachineColumn> columns) {
  if (columns.empty()) return "";
  const std::string hint =
      "Any column of supports.csv and probes.csv over any other: forces are those on the body.";
  return element("section",
                 element("h2", "Testing machine") + element("p", hint, "class=\"quiet hint\"") +
                     element("div", "", "id=\"machine\""),
                 "class=\"needs-script\"");
}

std::string view_section(std::string_view worst) {
  constexpr std::string_view place = "{worst}";
  std::string markup(view_markup());
  return markup.replace(markup.find(place), place.size(), worst);
}

std::string fact_lists(const std::vector<FactGroup>& all) {
  std::string groups;
  for (const FactGroup& group : all) {
    if (group.facts.empty()) continue;
    std::string rows;
    for (const Fact& fact : group.facts)
      rows += element("dt", escaped(fact.name)) + element("dd", escaped(fact.value));
    groups += element("section", element("h3", escaped(group.title)) + element("dl", rows));
  }
  return groups.empty() ? "" : element("div", groups, "class=\"facts\"");
}

std::string unfolded(const std::string& title, const std::string& markup) {
  return element("details", element("summary", element("h2", escaped(title))) + markup,
                 "class=\"part\" open");
}

std::string folded(const std::string& title, const std::string& text) {
  if (text.empty()) return "";
  return element("details", element("summary", escaped(title)) + element("pre", escaped(text)));
}

}  // namespace sinew

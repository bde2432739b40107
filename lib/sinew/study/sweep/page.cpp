// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/study/sweep/sweep_table.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numeric>
#include <optional>

#include <sinew/core/color.h>
#include <sinew/core/system.h>
#include <sinew/core/text.h>
#include <sinew/metrics/markup.h>
#include <sinew/metrics/report/page.h>
#include <sinew/metrics/table.h>
#include <sinew/settings/values.h>
#include <sinew/study/convergence.h>
#include <sinew/study/study_files.h>
#include <sinew/study/sweep/effects.h>

namespace sinew {
namespace {

/// The values of a key over the runs: their places in the order of first use, and as numbers.
struct Factor {
  std::string path;
  std::vector<std::string> levels;
  std::vector<std::size_t> level;  ///< one per run
  std::vector<double> numbers;     ///< one per run; empty where one of them is none
};

std::vector<Factor> factors_of(const Sweep& sweep) {
  std::vector<Factor> factors;
  for (std::size_t q = 0; q < sweep.file.vary.size(); ++q) {
    Factor& factor = factors.emplace_back();
    factor.path = sweep.file.vary[q].path;
    bool numeric = true;
    for (const SweepRun& run : sweep.runs) {
      const std::string& value = run.values[q];
      const auto at = std::find(factor.levels.begin(), factor.levels.end(), value);
      factor.level.push_back(static_cast<std::size_t>(at - factor.levels.begin()));
      if (at == factor.levels.end()) factor.levels.push_back(value);
      const auto number = parse_number(value);
      numeric = numeric && number && std::isfinite(*number);
      factor.numbers.push_back(number.value_or(0));
    }
    if (!numeric) factor.numbers.clear();
  }
  return factors;
}

std::vector<double> results_of(const SweepTable& table, std::size_t result) {
  std::vector<double> values;
  for (const SweepRow& row : table) values.push_back(row.results[result]);
  return values;
}

std::string unit_of(const AskedResult& asked) {
  const std::size_t index = metric_index(asked.name);
  return index < metrics_table().size() ? std::string(metrics_table()[index].unit) : "";
}

std::string header(const SweepTable& table, const std::string& title) {
  const auto count = [&](RunStatus status) {
    return std::count_if(table.begin(), table.end(),
                         [&](const SweepRow& row) { return row.state.status == status; });
  };
  std::string line = std::to_string(count(RunStatus::finished)) + " of " +
                     std::to_string(table.size()) + " runs finished";
  if (const auto failed = count(RunStatus::failed); failed > 0)
    line += ", " + std::to_string(failed) + " failed";
  if (const auto missing = count(RunStatus::missing); missing > 0)
    line += ", " + std::to_string(missing) + " are missing";
  return element("header", element("h1", escaped(title)) +
                               element("p", escaped(line + '.'), "class=\"quiet\""));
}

std::string picture_of(const std::string& run, const std::filesystem::path& folder) {
  const std::string file = "runs/" + run + "/picture.png";
  if (!std::filesystem::exists(folder / file)) return "";
  return "<img class=\"small\" loading=\"lazy\" alt=\"\" src=\"" + link_to(file) + "\">";
}

/// Failed runs first, the others by their first result, the largest first.
std::string runs_table(const Sweep& sweep, const SweepTable& table) {
  std::vector<std::size_t> order(table.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto key = [&](std::size_t k) {
    const double value = table[k].results[0];
    return std::pair(table[k].state.status != RunStatus::failed, std::isnan(value) ? 0 : -value);
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  std::vector<std::string> titles;
  for (const AskedResult& asked : sweep.file.results) titles.push_back(asked.title());
  std::string rows;
  for (const std::size_t k : order) {
    const SweepRun& run = sweep.runs[k];
    const RunState& state = table[k].state;
    std::vector<Cell> cells;
    for (std::size_t q = 0; q < run.values.size(); ++q)
      cells.push_back({sweep.file.vary[q].path, run.values[q]});
    for (std::size_t r = 0; r < titles.size(); ++r)
      cells.push_back({titles[r], readable(table[k].results[r])});
    std::string first = picture_of(run.name, sweep.folder);
    const std::string page = "runs/" + run.name + "/report.html";
    if (state.status == RunStatus::finished)
      first += element("a", std::to_string(k + 1), "href=\"" + link_to(page) + '"');
    else
      first += std::to_string(k + 1) + ' ' + element("b", escaped(word_of(state.status)));
    if (!state.reason.empty()) first += element("small", escaped(state.reason));
    rows += row(first, cells);
  }
  std::vector<std::string_view> columns = {"run"};
  for (const VariedKey& varied : sweep.file.vary) columns.push_back(varied.path);
  columns.insert(columns.end(), titles.begin(), titles.end());
  return element("h2", "Runs") +
         element("p", "Click a column to sort by it.", "class=\"quiet hint needs-script\"") +
         element("div", sinew::table(columns, rows), "class=\"sorts\"");
}

/// The limit of the means over the radius of particles, where the other settings have the same
/// values at each; else nothing is added.
void add_limit_of(const Factor& factor, const Sweep& sweep, const AskedResult& asked,
                  const std::vector<LevelMean>& means, LawCurve& curve) {
  const bool is_grid = sweep.file.design.kind == DesignKind::grid || sweep.file.vary.size() == 1;
  const auto is_whole = [&](const LevelMean& mean) {
    return mean.runs == sweep.runs.size() / factor.levels.size();
  };
  if (factor.path != "body.radius" || !is_grid ||
      !std::all_of(means.begin(), means.end(), is_whole))
    return;
  const CurveLine line = curve.lines.front();
  add_limit(curve, within(continuum_limit(line.x, line.y), range_of(asked.name)));
}

/// Means over the runs with one value, and their extremes.
std::optional<LawCurve> response(const Factor& factor, const Sweep& sweep, const AskedResult& asked,
                                 const std::vector<double>& results) {
  if (factor.numbers.empty() || factor.levels.size() < 2) return std::nullopt;
  std::map<double, std::size_t> at;
  for (std::size_t k = 0; k < factor.level.size(); ++k) at[factor.numbers[k]] = factor.level[k];
  const std::vector<LevelMean> means = level_means(factor.level, results, factor.levels.size());
  LawCurve curve{
      asked.title(), "Mean over the runs with each value", factor.path, unit_of(asked), {}};
  CurveLine line{"mean", {}, {}}, low{"min", {}, {}}, high{"max", {}, {}};
  for (const auto& [x, level] : at) {
    if (means[level].runs == 0) continue;
    double lowest = means[level].mean, highest = lowest;
    for (std::size_t k = 0; k < results.size(); ++k)
      if (factor.level[k] == level && std::isfinite(results[k]))
        lowest = std::min(lowest, results[k]), highest = std::max(highest, results[k]);
    line.x.push_back(x), line.y.push_back(means[level].mean);
    low.x.push_back(x), low.y.push_back(lowest);
    high.x.push_back(x), high.y.push_back(highest);
  }
  if (line.x.size() < 2) return std::nullopt;
  curve.lines = {std::move(line)};
  if (sweep.runs.size() > factor.levels.size())
    curve.lines.insert(curve.lines.end(), {std::move(low), std::move(high)});
  add_limit_of(factor, sweep, asked, means, curve);
  return curve;
}

std::string percent(double part) { return fixed(100 * part, 1) + '%'; }

/// A bar from the middle to a part of -1 to 1 of the width; of parts that have no sign, from the
/// left.
std::string bar(double part, bool has_sign) {
  const double size = std::min(1.0, std::abs(part)) / (has_sign ? 2 : 1);
  const std::string style = "left:" +
                            percent(!has_sign  ? 0
                                    : part < 0 ? 0.5 - size
                                               : 0.5) +
                            ";width:" + percent(size);
  return element("span", element("i", "", "style=\"" + style + '"'), "class=\"bar\"");
}

struct Effect {
  std::string name, words;
  double part = 0;  ///< -1 to 1
};

/// Main effects, or of random designs correlations, the largest first.
std::vector<Effect> effects_of(const Sweep& sweep, const std::vector<Factor>& factors,
                               const std::vector<double>& results) {
  std::vector<Effect> effects;
  double most = 0;
  for (const Factor& factor : factors) {
    if (sweep.file.design.is_random()) {
      if (factor.numbers.empty()) continue;
      const RankCorrelation found = rank_correlation(factor.numbers, results);
      if (!std::isnan(found.value))
        effects.push_back(
            {factor.path, fixed(found.value, 2) + " ± " + fixed(found.error, 2), found.value});
      continue;
    }
    const auto means = level_means(factor.level, results, factor.levels.size());
    const double effect = main_effect(means);
    if (std::isnan(effect)) continue;
    effects.push_back({factor.path, readable(effect), effect});
    most = std::max(most, effect);
  }
  if (most > 0)
    for (Effect& effect : effects) effect.part /= most;
  std::stable_sort(effects.begin(), effects.end(), [](const Effect& a, const Effect& b) {
    return std::abs(a.part) > std::abs(b.part);
  });
  return effects;
}

std::string effects_section(const Sweep& sweep, const SweepTable& table,
                            const std::vector<Factor>& factors) {
  const bool random = sweep.file.design.is_random();
  std::string tables;
  for (std::size_t r = 0; r < sweep.file.results.size(); ++r) {
    const std::vector<Effect> effects = effects_of(sweep, factors, results_of(table, r));
    if (effects.empty()) continue;
    std::string rows;
    for (const Effect& one : effects)
      rows += "<tr><td>" + element("code", escaped(one.name)) + "</td><td>" +
              bar(one.part, random) + "</td><td>" + escaped(one.words) + "</td></tr>";
    const std::string unit = random ? "" : unit_of(sweep.file.results[r]);
    tables += element("div", element("h3", escaped(sweep.file.results[r].title() +
                                                   (unit.empty() ? "" : ", " + unit))) +
                                 element("table", rows, "class=\"effects\""));
  }
  if (tables.empty() && random)
    tables = element("p", "Fewer than " + std::to_string(min_correlated) +
                              " runs have a result: too few to tell a correlation.");
  if (tables.empty()) return "";
  const std::string hint =
      random
          ? "Correlation of ranks (Spearman's), from -1 to 1, with its standard error by bootstrap."
          : "Largest less smallest mean of the runs with one value of the setting.";
  return element("h2", random ? "Correlations" : "Main effects") +
         element("p", hint, "class=\"quiet hint\"") + element("div", tables, "class=\"several\"");
}

/// Means over the first two settings that vary, as colored cells.
std::string heat_map(const std::vector<Factor>& two, const AskedResult& asked,
                     const std::vector<double>& results) {
  const Factor &across = two[0], &down = two[1];
  const std::size_t wide = across.levels.size();
  std::vector<std::size_t> cell;
  for (std::size_t k = 0; k < results.size(); ++k)
    cell.push_back(down.level[k] * wide + across.level[k]);
  const auto means = level_means(cell, results, wide * down.levels.size());
  double low = INFINITY, high = -INFINITY;
  for (const LevelMean& one : means)
    if (one.runs > 0) low = std::min(low, one.mean), high = std::max(high, one.mean);
  std::string rows = "<tr><th></th>";
  for (const std::string& level : across.levels) rows += element("th", escaped(level));
  rows += "</tr>";
  for (std::size_t y = 0; y < down.levels.size(); ++y) {
    rows += "<tr>" + element("th", escaped(down.levels[y]));
    for (std::size_t x = 0; x < wide; ++x) {
      const LevelMean& one = means[y * wide + x];
      const double part = high > low ? (one.mean - low) / (high - low) : 0;
      const std::string style = "style=\"background:color-mix(in srgb, var(--accent) " +
                                percent(0.08 + 0.72 * part) + ", transparent)\"";
      rows += one.runs == 0 ? "<td>–</td>" : element("td", readable(one.mean), style);
    }
    rows += "</tr>";
  }
  return element("div", element("h3", escaped(asked.title())) +
                            element("p", escaped(down.path + " down, " + across.path + " across"),
                                    "class=\"quiet\"") +
                            element("table", rows, "class=\"heat\""));
}

std::string heat_maps(const Sweep& sweep, const SweepTable& table,
                      const std::vector<Factor>& factors) {
  constexpr std::size_t max_levels = 24;
  std::vector<Factor> two;
  for (const Factor& factor : factors)
    if (two.size() < 2 && factor.levels.size() > 1 && factor.levels.size() <= max_levels)
      two.push_back(factor);
  if (two.size() < 2 || sweep.file.design.kind != DesignKind::grid) return "";
  std::string maps;
  for (std::size_t r = 0; r < sweep.file.results.size(); ++r)
    maps += heat_map(two, sweep.file.results[r], results_of(table, r));
  return element("h2", "Two settings at once") + element("div", maps, "class=\"several\"");
}

std::vector<LawCurve> curves_of(const Sweep& sweep, const SweepTable& table,
                                const std::vector<Factor>& factors) {
  constexpr std::size_t max_responses = 24;
  std::vector<LawCurve> curves;
  for (std::size_t r = 0; r < sweep.file.results.size(); ++r)
    for (const Factor& factor : factors)
      if (auto curve = response(factor, sweep, sweep.file.results[r], results_of(table, r));
          curve && curves.size() < max_responses && !sweep.file.design.is_random())
        curves.push_back(std::move(*curve));
  return curves;
}

constexpr std::string_view style =
    "<style>.sorts .small{width:72px;display:inline-block;vertical-align:middle;margin-right:8px}"
    ".sorts td{vertical-align:middle}.sorts td:first-child{white-space:nowrap}"
    ".sorts small{display:block;white-space:normal}"
    ".several{display:flex;flex-wrap:wrap;gap:24px}.several>div{max-width:100%;overflow-x:auto}"
    ".effects td:first-child{overflow-wrap:anywhere}.effects td:last-child{white-space:nowrap}"
    ".bar{position:relative;display:block;width:min(160px,12vw);height:12px;background:#8883}"
    ".bar i{position:absolute;top:0;bottom:0;background:var(--accent)}"
    ".sorts th{cursor:pointer}.sorts [aria-sort=ascending]::after{content:' ↑'}"
    ".sorts [aria-sort=descending]::after{content:' ↓'}"
    ".heat td{text-align:right;padding:4px 8px}</style>";

}  // namespace

std::string sweep_html(const Sweep& sweep, const SweepTable& table, const std::string& title) {
  const std::vector<Factor> factors = factors_of(sweep);
  PageData data;
  data.curves = curves_of(sweep, table, factors);
  const std::string body =
      std::string(style) + header(table, title) + effects_section(sweep, table, factors) +
      heat_maps(sweep, table, factors) + curves_section("Over one setting", data.curves) +
      runs_table(sweep, table);
  const Playback none;
  return page_html({title, version(), body, "results.csv", std::move(data), none,
                    "The numbers of this page are in results.csv, those of every frame in the "
                    "folders of the runs."});
}

}  // namespace sinew

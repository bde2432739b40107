// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/study/study_files.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <sinew/core/system.h>
#include <sinew/metrics/markup.h>
#include <sinew/metrics/report/charts.h>
#include <sinew/metrics/report/page.h>
#include <sinew/metrics/table.h>

namespace sinew {
namespace {

constexpr std::size_t max_curves = 30;  // number of curves over the radius
// Fraction of its unit's largest result: less is zero but for rounding and sides of the packing.
constexpr double telling = 1e-3;
constexpr const char* of_limits =
    "The line at radius 0 is the limit with its error: that of a parabola through the runs.";

std::string header(const Study& study, const std::string& title) {
  const std::vector<FrameMetrics>& frames = study.runs.front().frames;
  std::string line = std::to_string(frames.size()) + " frames of the same times, from " +
                     readable(frames.front().time) + " s to " + readable(frames.back().time) +
                     " s.";
  if (study.by_radius)
    line +=
        " The runs differ in the radius of their particles alone: limits are those of the body "
        "without particles.";
  return element("header",
                 element("h1", escaped(title)) + element("p", escaped(line), "class=\"quiet\""));
}

std::string runs_table(const Study& study) {
  std::string rows;
  for (const StudiedRun& run : study.runs)
    rows += row(element("code", escaped(run.name)), {{"particles", std::to_string(run.particles)},
                                                     {"radius, m", readable(run.radius)},
                                                     {"stepping, s", readable(run.seconds)}});
  return element("h2", "Runs") + table({"run", "particles", "radius, m", "stepping, s"}, rows);
}

// Results over the radius.

/// "2 ± 0.1", or that there is none.
std::string limit_text(const ContinuumLimit& limit) {
  return std::isfinite(limit.value) ? readable(limit.value) + " ± " + readable(limit.error)
                                    : "does not converge";
}

double spread_of(const StudiedResult& result) {
  const auto [low, high] = std::minmax_element(result.values.begin(), result.values.end());
  return *high - *low;
}

/// Whether readers look for it first: forces and displacements of a testing machine at the end, or
/// without one the metrics that the report links to.
bool is_headline(const StudiedResult& result, bool machine) {
  if (machine) return result.kind == "final" && result.name.find(": ") != std::string::npos;
  const auto names = headline_metrics();
  return result.kind == "worst" &&
         std::find(names.begin(), names.end(), result.name) != names.end();
}

LawCurve curve_of(const Study& study, const StudiedResult& result) {
  std::vector<std::pair<double, double>> points;
  for (std::size_t i = 0; i < study.runs.size(); ++i)
    points.emplace_back(study.runs[i].radius, result.values[i]);
  std::sort(points.begin(), points.end());
  LawCurve curve{result.name + ", " + result.kind, "", "radius (m)", result.unit, {}};
  CurveLine& runs = curve.lines.emplace_back(CurveLine{"runs", {}, {}});
  for (const auto& [radius, value] : points) runs.x.push_back(radius), runs.y.push_back(value);
  add_limit(curve, result.limit);
  return curve;
}

std::vector<LawCurve> curves_of(const Study& study) {
  const bool machine = !study.runs.front().machine.empty();
  std::map<std::string, double> largest;  // one per unit
  const auto size_of = [](const StudiedResult& result) { return std::abs(result.values.back()); };
  const auto drawn = [&](const StudiedResult& result) {
    return result.measured() && is_headline(result, machine) && spread_of(result) > 0;
  };
  for (const StudiedResult& result : study.results)
    if (drawn(result)) largest[result.unit] = std::max(largest[result.unit], size_of(result));
  std::vector<LawCurve> curves;
  for (const StudiedResult& result : study.results)
    if (curves.size() < max_curves && drawn(result) &&
        size_of(result) > telling * largest[result.unit])
      curves.push_back(curve_of(study, result));
  return curves;
}

// All results.

std::string result_row(const Study& study, const StudiedResult& result) {
  std::vector<Cell> cells;
  for (std::size_t i = 0; i < study.runs.size(); ++i)
    cells.push_back({study.runs[i].name, readable(result.values[i])});
  if (study.by_radius) {
    cells.push_back(
        {"limit", result.measured() ? limit_text(result.limit) : readable(not_measured)});
    cells.push_back({"order", fixed(result.limit.order, 1)});
  }
  const std::string unit =
      result.unit.empty() ? "" : element("span", escaped(result.unit), "class=\"unit\"");
  return row(element("code", escaped(result.name)) + unit + element("small", result.kind), cells);
}

std::string results_table(const Study& study) {
  std::string rows;
  for (const StudiedResult& result : study.results) rows += result_row(study, result);
  std::vector<std::string_view> columns = {"result"};
  for (const StudiedRun& run : study.runs) columns.push_back(run.name);
  if (study.by_radius) columns.insert(columns.end(), {"limit", "order"});
  return element("h2", "Results") + table(columns, rows);
}

// Over time.

Chart chart_of(const ChartPlan& plan, std::string_view metric, const Study& study) {
  std::string title(metric);
  std::replace(title.begin(), title.end(), '_', ' ');
  Chart chart{std::move(title),
              std::string(metrics_table()[metric_index(metric)].help),
              std::string(plan.unit),
              plan.baselines,
              plan.span,
              plan.drawn,
              {},
              plan.topic};
  for (const StudiedRun& run : study.runs)
    chart.lines.push_back(
        {run.name, shown_values(plan, metric, run.frames, study.runs.front().radius)});
  return chart;
}

Chart chart_of(const MachineColumn& column, const Study& study) {
  Chart chart{column.name, "Of supports, loads and probes", column.unit, {0}, 0, Drawn::unless_zero,
              {}};
  for (const StudiedRun& run : study.runs)
    for (const MachineColumn& one : run.machine)
      if (one.name == column.name) chart.lines.push_back({run.name, one.values});
  return chart;
}

std::vector<Chart> charts_of(const Study& study) {
  std::vector<Chart> charts;
  for (const MachineColumn& column : study.runs.front().machine)
    charts.push_back(chart_of(column, study));
  std::set<std::string_view> drawn;
  for (const ChartPlan& plan : chart_plans())
    for (const auto& [metric, words] : plan.metrics)
      if (drawn.insert(metric).second) charts.push_back(chart_of(plan, metric, study));
  leave_out_empty(charts);
  put_in_order(charts);
  return charts;
}

PageData drawn_data(const Study& study) {
  PageData data;
  for (const FrameMetrics& frame : study.runs.front().frames) {
    data.times.push_back(frame.time);
    data.angles.push_back(frame.bone_angle);
  }
  data.charts = charts_of(study);
  if (study.by_radius) data.curves = curves_of(study);
  return data;
}

}  // namespace

void add_limit(LawCurve& curve, const ContinuumLimit& limit) {
  if (!curve.note.empty()) curve.note += ". ";
  curve.note += "Limit: " + limit_text(limit);
  if (std::isfinite(limit.order)) curve.note += ", order " + fixed(limit.order, 1);
  if (std::isfinite(limit.value))
    curve.lines.push_back(
        {"limit", {0, 0, 0}, {limit.value - limit.error, limit.value, limit.value + limit.error}});
}

std::string study_html(const Study& study, const std::string& title) {
  PageData data = drawn_data(study);
  const std::string settings = study.settings.empty() ? element("p", "No setting does.")
                                                      : fact_lists(facts_of(study.settings));
  const std::string body = header(study, title) + remarks(study.remarks) + runs_table(study) +
                           element("h2", "Differences between the scenes") + settings +
                           curves_section("Over the radius", data.curves, of_limits) +
                           charts_section(false) + results_table(study);
  const Playback none;
  return page_html({title, version(), body, "study.csv", std::move(data), none,
                    "The numbers of this page are in study.csv and study.json, those of every "
                    "frame in the folders of the runs."});
}

}  // namespace sinew

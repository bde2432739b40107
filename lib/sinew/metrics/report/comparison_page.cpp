// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/report/comparison_page.h>

#include <algorithm>

#include <sinew/metrics/report/charts.h>
#include <sinew/metrics/report/markup.h>
#include <sinew/metrics/report/page.h>
#include <sinew/metrics/report/page_data.h>
#include <sinew/metrics/report/tables.h>
#include <sinew/metrics/table.h>

namespace sinew {
namespace {

std::string name_of(const RunComparison& compared, bool second) {
  return second ? "b: " + compared.second.name : "a: " + compared.first.name;
}

std::string header(const RunComparison& compared) {
  const std::string line =
      std::to_string(compared.differences.size()) + " frames of the same times, from " +
      readable(compared.differences.front().time) + " s to " +
      readable(compared.differences.back().time) + " s. Differences are b less a. One r is " +
      readable(compared.first.radius) + " m, the radius of a particle of a.";
  return element("header", element("h1", escaped(compared.first.name) + " and " +
                                             escaped(compared.second.name)) +
                               element("p", line, "class=\"quiet\""));
}

std::string remarks(const RunComparison& compared) {
  std::string items;
  for (const std::string& remark : compared.remarks) items += element("li", escaped(remark));
  return items.empty() ? "" : element("ul", items, "class=\"remarks\"");
}

std::string verdict_of(const ComparedRun& run, const std::string& name) {
  return element("h2", escaped(name)) + verdict_cards(run.frames, run.summary, run.radius);
}

bool all_measured_nowhere(const Chart& chart) {
  return std::all_of(chart.lines.begin(), chart.lines.end(), [](const Line& line) {
    return std::none_of(line.values.begin(), line.values.end(), drawable);
  });
}

/// One metric of both runs over each other.
Chart chart_of_both(const ChartPlan& plan, std::string_view metric, const RunComparison& compared) {
  ChartPlan one = plan;
  one.metrics = {metric};
  const double radius = compared.first.radius;
  Chart chart = planned_chart(one, compared.first.frames, radius);
  chart.lines[0].name = name_of(compared, false);
  Chart second = planned_chart(one, compared.second.frames, radius);
  chart.lines.push_back({name_of(compared, true), std::move(second.lines[0].values)});
  chart.title = metric;
  std::replace(chart.title.begin(), chart.title.end(), '_', ' ');
  chart.note = metrics_table()[metric_index(metric)].help;
  return chart;
}

Chart chart_of_distances(const RunComparison& compared) {
  const ChartPlan plan{"Distance between the two",
                       "Of the same particles, of the same points of the surface, and of the "
                       "nearest places",
                       "r of a",
                       {"reference_particles_rms", "reference_particles_max",
                        "reference_surface_rms", "reference_hausdorff", "reference_distance_mean"},
                       Shown::in_radii};
  Chart chart = planned_chart(plan, compared.differences, compared.first.radius);
  for (std::size_t i = 0; i < compared.first.frames.size(); ++i)
    chart.angles[i] = compared.first.frames[i].bone_angle;
  return chart;
}

std::vector<Chart> charts_of(const RunComparison& compared) {
  std::vector<Chart> charts{chart_of_distances(compared)};
  std::vector<std::string_view> drawn;
  for (const ChartPlan& plan : chart_plans())
    for (const std::string_view metric : plan.metrics) {
      if (std::find(drawn.begin(), drawn.end(), metric) != drawn.end()) continue;
      drawn.push_back(metric);
      charts.push_back(chart_of_both(plan, metric, compared));
    }
  std::erase_if(charts, all_measured_nowhere);
  return charts;
}

/// What the page's script is told: the buttons of worst frames lead to the largest differences.
std::string numbers(const ComparisonInput& input, const std::vector<Chart>& charts) {
  ReportInput told;
  told.frames = input.comparison.differences;
  told.summary = input.comparison.summary;
  for (std::size_t i = 0; i < told.summary.metrics.size(); ++i)
    told.summary.metrics[i].worst_frame = largest_difference(input.comparison, i);
  told.playback = input.playback;
  return page_data(told, charts);
}

std::string playback_section(const ComparisonInput& input) {
  if (input.playback.frames.empty()) return "";
  return element("h2", "Side by side") +
         element("p",
                 escaped(name_of(input.comparison, false)) + " beside " +
                     escaped(name_of(input.comparison, true)) +
                     ", at the same time and in the same colors.",
                 "class=\"quiet\"") +
         view_section("Largest difference of");
}

}  // namespace

std::string comparison_html(const ComparisonInput& input) {
  const RunComparison& compared = input.comparison;
  const std::vector<Chart> charts = charts_of(compared);
  const std::string body =
      header(compared) + remarks(compared) + verdict_of(compared.first, name_of(compared, false)) +
      verdict_of(compared.second, name_of(compared, true)) + checks_table(compared.checks) +
      playback_section(input) + charts_section(charts, !input.playback.frames.empty()) +
      differences_table(compared) + element("h2", "What differs in the scenes") +
      (input.facts.empty() ? element("p", "No setting does.") : fact_lists(input.facts)) +
      folded("The resolved scene of " + name_of(compared, false), input.first_scene) +
      folded("The resolved scene of " + name_of(compared, true), input.second_scene);
  return page_html({compared.first.name + " and " + compared.second.name, input.version, body,
                    "The same numbers, frame by frame, are in compare.csv, and summed up in "
                    "metrics.json.",
                    numbers(input, charts)});
}

}  // namespace sinew

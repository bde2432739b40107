// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/report/comparison_page.h>

#include <algorithm>
#include <limits>
#include <set>

#include <sinew/metrics/markup.h>
#include <sinew/metrics/report/charts.h>
#include <sinew/metrics/report/page.h>
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
      readable(compared.differences.back().time) + " s. Differences are b minus a. One r is " +
      readable(compared.first.radius) + " m, the radius of a particle of a.";
  return element("header", element("h1", escaped(compared.first.name) + " and " +
                                             escaped(compared.second.name)) +
                               element("p", line, "class=\"quiet\""));
}

std::string verdict_of(const ComparedRun& run, const std::string& name) {
  return element("h2", escaped(name)) +
         verdict_cards(run.frames, run.summary, run.radius, run.particles);
}

/// One metric of both runs in one chart.
Chart chart_of_both(const ChartPlan& plan, std::string_view metric, const RunComparison& compared) {
  const double radius = compared.first.radius;
  std::string title(metric);
  std::replace(title.begin(), title.end(), '_', ' ');
  return {title,
          std::string(metrics_table()[metric_index(metric)].help),
          std::string(plan.unit),
          plan.baselines,
          plan.span,
          plan.drawn,
          {{name_of(compared, false), shown_values(plan, metric, compared.first.frames, radius)},
           {name_of(compared, true), shown_values(plan, metric, compared.second.frames, radius)}},
          plan.topic};
}

Chart chart_of_distances(const RunComparison& compared) {
  const ChartPlan plan{"Distance between the two",
                       "Of the same particles, of the same points of the surface, and of the "
                       "nearest places",
                       "r of a",
                       {{"reference_particles_rms", "particles, root mean square"},
                        {"reference_particles_max", "particles, largest"},
                        {"reference_surface_rms", "surface, root mean square"},
                        {"reference_hausdorff", "nearest places, largest"},
                        {"reference_distance_mean", "nearest places, mean"}},
                       Shown::in_radii};
  return planned_chart(plan, compared.differences, compared.first.radius);
}

std::vector<Chart> charts_of(const ComparisonInput& input) {
  const RunComparison& compared = input.comparison;
  std::vector<Chart> charts = input.charts;
  charts.push_back(chart_of_distances(compared));
  std::set<std::string_view> drawn;
  for (const ChartPlan& plan : chart_plans())
    for (const auto& [metric, words] : plan.metrics)
      if (drawn.insert(metric).second) charts.push_back(chart_of_both(plan, metric, compared));
  leave_out_empty(charts);
  put_in_order(charts);
  return charts;
}

/// The buttons of worst frames show the largest differences.
PageData drawn_data(const ComparisonInput& input) {
  const RunComparison& compared = input.comparison;
  PageData data;
  for (const FrameMetrics& frame : compared.first.frames) {
    data.times.push_back(frame.time);
    data.angles.push_back(frame.bone_angle);
  }
  data.charts = charts_of(input);
  data.curves = input.curves;
  Summary worst = compared.summary;
  for (std::size_t i = 0; i < worst.metrics.size(); ++i)
    worst.metrics[i].worst_frame = largest_difference(compared, i);
  data.worst = worst_frames(compared.differences, worst);
  return data;
}

std::string playback_section(const ComparisonInput& input) {
  if (input.playback.frames.empty()) return "";
  const std::string line = name_of(input.comparison, false) + " beside " +
                           name_of(input.comparison, true) +
                           ", at the same time and in the same colors.";
  return element("section",
                 element("h2", "Side by side") + element("p", escaped(line), "class=\"quiet\"") +
                     view_section("Largest difference of"),
                 "class=\"needs-script\"");
}

/// The metrics of both runs, and their differences.
std::string differences_table(const RunComparison& compared) {
  std::string rows, run_rows;
  for (std::size_t i = 1; i < metrics_table().size(); ++i) {
    const auto largest = largest_difference(compared, i);
    if (!largest) continue;
    const Metric& metric = metrics_table()[i];
    const bool own = is_distance(metric.name);
    const FrameMetrics& at = compared.differences[*largest];
    const auto final = [&](const ComparedRun& run) {
      return own ? not_measured : run.frames.back().*metric.value;
    };
    rows += row(described(metric), {{"a, final", readable(final(compared.first))},
                                    {"b, final", readable(final(compared.second))},
                                    {"b − a, final", readable(compared.summary.metrics[i].final)},
                                    {"largest", readable(at.*metric.value)},
                                    {"at", readable(at.time) + " s"}});
  }
  for (const RunMetric& metric : run_metrics_table())
    run_rows += row(described(metric), {{"a", readable(compared.first.summary.*metric.value)},
                                        {"b", readable(compared.second.summary.*metric.value)},
                                        {"b − a", readable(compared.summary.*metric.value)}});
  return unfolded(
             "Differences",
             table({"metric", "a, final", "b, final", "b − a, final", "largest", "at"}, rows)) +
         unfolded("Metrics of the whole runs", table({"metric", "a", "b", "b − a"}, run_rows));
}

constexpr double gap = 0.15;  // between the two, relative to the size of the first

/// Displacement of the second playback, which places it beside the first. The camera looks along x
/// or y, whichever extent is smaller: it sees both where they are placed along the other.
Vec3 shift_aside(const Playback& first, const Playback& second) {
  const Box one = box_of(first), other = box_of(second);
  if (one.isEmpty() || other.isEmpty()) return Vec3::Zero();
  const Vec3 size = one.sizes().cwiseMax(other.sizes());
  const int axis = size.x() >= size.y() ? 0 : 1;
  Vec3 shift = Vec3::Zero();
  for (int k = 0; k < 3; ++k)  // a body far away would make both of them dots
    if (std::abs(one.center()[k] - other.center()[k]) > 2 * size.maxCoeff())
      shift[k] = one.min()[k] - other.min()[k];
  shift[axis] = one.max()[axis] - other.min()[axis] + gap * size[axis];
  return shift;
}

void append_moved(std::vector<float>& all, const std::vector<float>& places, const Vec3& shift) {
  for (std::size_t i = 0; i < places.size(); ++i)
    all.push_back(static_cast<float>(places[i] + shift[static_cast<int>(i % 3)]));
}

/// Not-a-number for the playback that has no such values.
void append_values(std::vector<float>& all, std::vector<float> values, std::size_t before,
                   std::size_t count) {
  if (all.empty() && values.empty()) return;
  all.resize(before, std::numeric_limits<float>::quiet_NaN());
  values.resize(count, std::numeric_limits<float>::quiet_NaN());
  all.insert(all.end(), values.begin(), values.end());
}

/// The positions and fields of a frame, those of the second appended.
PlaybackFrame joined(PlaybackFrame frame, const PlaybackFrame& other, const Vec3& shift) {
  const std::size_t before = frame.particles.size() / 3, count = other.particles.size() / 3;
  for (std::size_t f = 0; f < frame.values.size(); ++f)
    append_values(frame.values[f], other.values[f], before, count);
  append_moved(frame.particles, other.particles, shift);
  append_moved(frame.surface, other.surface, shift);
  append_moved(frame.bones, other.bones, shift);
  append_moved(frame.forces, other.forces, shift);
  append_moved(frame.obstacles, other.obstacles, shift);
  return frame;
}

/// The bones of the second appended.
void join_bones(Playback& playback, const Playback& second,
                const std::array<std::string, 2>& prefixes) {
  const std::vector<std::string> first = playback.bone_names;
  const auto has = [](const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  for (std::string& name : playback.bone_names)
    if (!has(second.bone_names, name)) name.insert(0, prefixes[0]);
  int colors = static_cast<int>(first.size());
  for (const std::string& name : second.bone_names) {
    const auto same = std::find(first.begin(), first.end(), name) - first.begin();
    const bool shared = has(first, name);
    playback.bone_names.push_back(shared ? name : prefixes[1] + name);
    playback.bone_color.push_back(shared ? static_cast<int>(same) : colors++);
  }
}

/// Appends materials of the second; the same name is the same material.
void join_materials(Playback& playback, const Playback& second) {
  if (playback.material.empty() && second.material.empty()) return;
  std::vector<std::string>& names = playback.material_names;
  if (names.empty()) names = {second.material_names.front()};
  playback.material.resize(playback.particles.size(), 0);
  std::vector<int> number;
  for (const std::string& name : second.material_names) {
    const auto same = std::find(names.begin(), names.end(), name);
    number.push_back(static_cast<int>(same - names.begin()));
    if (same == names.end()) names.push_back(name);
  }
  for (std::size_t i = 0; i < second.particles.size(); ++i)
    playback.material.push_back(
        second.material.empty() ? 0 : number[static_cast<std::size_t>(second.material[i])]);
}

void join_shape(Playback& playback, const Playback& second,
                const std::array<std::string, 2>& prefixes) {
  const auto bones = static_cast<int>(playback.bone_names.size());
  const auto points = static_cast<int>(playback.points.size());
  join_bones(playback, second, prefixes);
  for (const int bone : second.bone) playback.bone.push_back(bone < 0 ? -1 : bone + bones);
  for (const auto& [a, b, c] : second.faces)
    playback.faces.push_back({a + points, b + points, c + points});
  for (const std::uint32_t held : second.held)
    playback.held.push_back(held + static_cast<std::uint32_t>(playback.particles.size()));
  join_materials(playback, second);
  playback.is_load.insert(playback.is_load.end(), second.is_load.begin(), second.is_load.end());
  playback.particles.insert(playback.particles.end(), second.particles.begin(),
                            second.particles.end());
  playback.balls.insert(playback.balls.end(), second.balls.begin(), second.balls.end());
  playback.points.insert(playback.points.end(), second.points.begin(), second.points.end());
  playback.run_particles += second.run_particles;
  playback.run_points += second.run_points;
}

}  // namespace

Playback side_by_side(const Playback& first, const Playback& second,
                      const std::array<std::string, 2>& prefixes) {
  Playback playback = first;
  const Vec3 shift = shift_aside(first, second) + second.origin - first.origin;
  playback.frames.clear();
  for (const PlaybackFrame& frame : first.frames) {
    const auto other =
        std::find_if(second.frames.begin(), second.frames.end(),
                     [&](const PlaybackFrame& one) { return one.frame == frame.frame; });
    if (other != second.frames.end()) playback.frames.push_back(joined(frame, *other, shift));
  }
  join_shape(playback, second, prefixes);
  playback.ranges.clear();
  for (const auto& [quantity, range] : first.ranges)
    if (const auto other = second.ranges.find(quantity); other != second.ranges.end())
      playback.ranges[quantity] = {std::min(range.low, other->second.low),
                                   std::max(range.high, other->second.high)};
  return playback;
}

std::string comparison_html(const ComparisonInput& input) {
  const RunComparison& compared = input.comparison;
  const std::string body =
      header(compared) + remarks(compared.remarks) +
      verdict_of(compared.first, name_of(compared, false)) +
      verdict_of(compared.second, name_of(compared, true)) + checks_table(compared.checks) +
      playback_section(input) + curves_section("Load over displacement", input.curves) +
      charts_section(!input.playback.frames.empty()) + differences_table(compared) +
      element("h2", "Differences between the scenes") +
      (input.facts.empty() ? element("p", "No setting does.") : fact_lists(input.facts)) +
      folded("The resolved scene of " + name_of(compared, false), input.first_scene) +
      folded("The resolved scene of " + name_of(compared, true), input.second_scene);
  return page_html({compared.first.name + " and " + compared.second.name, input.version, body,
                    "compare.csv", drawn_data(input), input.playback});
}

}  // namespace sinew

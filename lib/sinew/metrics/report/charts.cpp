// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/report/charts.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include <sinew/metrics/table.h>

namespace sinew {
namespace {

std::vector<ChartPlan> plans_of_motion() {
  return {
      {"Tip",
       "Rotation of the last bone's outermost particles, and of the bone that rotates most",
       "degrees",
       {{"tip_angle", "outermost particles"}, {"bone_angle", "bone"}},
       Shown::as_is,
       5},
      {"Displacement",
       "From the places at rest",
       "r",
       {{"displacement_rms", "root mean square"}, {"displacement_max", "largest"}},
       Shown::in_radii,
       0.5},
      {"Speed", "Of the fastest particle", "m/s", {{"speed_max", "fastest"}}},
      {"Distance from the bones",
       "Distance of particles from the rigid pose of their bones",
       "r",
       {{"pose_error_rms", "all particles"},
        {"pose_error_far_rms", "those away from joints"},
        {"adherence_rms", "distance to the bone"}},
       Shown::in_radii,
       0.5},
      {"Surface and other poses: farthest",
       "From the rigid pose, linear-blend and dual-quaternion skinning, and a reference",
       "r",
       {{"pose_hausdorff", "rigid pose"},
        {"lbs_hausdorff", "linear blend"},
        {"dqs_hausdorff", "dual quaternions"},
        {"reference_hausdorff", "reference"}},
       Shown::in_radii,
       0.5},
      {"Surface and other poses: mean",
       "Mean distance from the same, over the area",
       "r",
       {{"pose_distance_mean", "rigid pose"},
        {"lbs_distance_mean", "linear blend"},
        {"dqs_distance_mean", "dual quaternions"},
        {"reference_distance_mean", "reference"}},
       Shown::in_radii,
       0.5},
  };
}

std::vector<ChartPlan> plans_of_deformation() {
  return {
      {"Strain",
       "Equivalent strain not exceeded by 50 %, 95 % and 99 % of the particles",
       "",
       {{"strain_50", "50 %"}, {"strain_95", "95 %"}, {"strain_99", "99 %"}},
       Shown::as_is,
       0.01},
      {"Volume",
       "Relative to the body at rest: of the surface, and the mean around particles",
       "",
       {{"volume_ratio", "surface"}, {"J_mean", "mean around particles"}},
       Shown::as_is,
       0.02,
       {1}},
      {"Smallest local volume",
       "Below zero the surroundings of a particle are inside out",
       "",
       {{"J_min", "smallest J"}},
       Shown::as_is,
       1,
       {0, 1}},
      {"Sections across the bones",
       "Largest loss of area (candy wrapper) and largest gain (bulge)",
       "%",
       {{"candy_wrapper", "loss"}, {"bulge", "gain"}},
       Shown::in_percent,
       2},
      {"Twist from half-plane to half-plane",
       "A cut body shows its whole angle in one step",
       "degrees",
       {{"twist_jump_max", "largest jump"}},
       Shown::as_is,
       2},
      {"Surface", "Area relative to rest", "", {{"area_ratio", "area"}}, Shown::as_is, 0.02, {1}},
  };
}

std::vector<ChartPlan> plans_of_forces() {
  return {
      {"Stress",
       "Von Mises stress not exceeded by 95 % of the particles",
       "Pa",
       {{"von_mises_95", "95 %"}}},
      {"Energies",
       "Change since the first frame",
       "J",
       {{"kinetic_energy", "kinetic"},
        {"pair_energy", "pairs"},
        {"bone_energy", "bones' springs"},
        {"gravity_energy", "weight"},
        {"work_of_bones", "work of bones"},
        {"dissipation", "dissipated"}},
       Shown::since_start},
      {"World",
       "Energy of contacts with obstacles, and the work of the world on the body, since the "
       "first frame",
       "J",
       {{"contact_energy", "contacts"}, {"work_of_world", "work of the world"}},
       Shown::since_start,
       0,
       {0},
       Drawn::unless_zero},
  };
}

std::vector<ChartPlan> plans_of_remains() {
  return {
      {"Neighbors",
       "Pairs lost and gained, as a share of the pairs at rest",
       "%",
       {{"broken_neighbors", "lost"},
        {"new_neighbors", "gained"},
        {"broken_bonds", "broken bonds"}},
       Shown::in_percent,
       1},
      {"Inverted particles",
       "Particles whose surroundings are inside out",
       "",
       {{"inverted", "inverted"}},
       Shown::as_is,
       20},
      {"Self-intersections",
       "Pairs of faces that intersect",
       "",
       {{"self_intersections", "pairs"}},
       Shown::as_is,
       20},
  };
}

std::vector<ChartPlan> plans_of_numerics() {
  return {
      {"Balance of energies",
       "Residual of the balance; zero for a perfect integrator",
       "J",
       {{"energy_residual", "residual"}}},
      {"Groups",
       "Particles that move in groups; all others are free",
       "%",
       {{"grouped", "grouped"}},
       Shown::in_percent,
       10},
  };
}

std::vector<ChartPlan> make_plans() {
  std::vector<ChartPlan> all;
  const auto add = [&](Topic topic, std::vector<ChartPlan> plans) {
    for (ChartPlan& plan : plans) {
      plan.topic = topic;
      all.push_back(std::move(plan));
    }
  };
  add(Topic::motion, plans_of_motion());
  add(Topic::deformation, plans_of_deformation());
  add(Topic::forces, plans_of_forces());
  add(Topic::remains, plans_of_remains());
  add(Topic::numerics, plans_of_numerics());
  return all;
}

double shown_value(const ChartPlan& plan, double value, double start, double radius) {
  switch (plan.shown) {
    case Shown::as_is:
      return value;
    case Shown::in_radii:
      return value / radius;
    case Shown::in_percent:
      return 100 * value;
    case Shown::since_start:
      return value - start;
  }
  return value;
}

bool never_measured(const Line& line) {
  return std::none_of(line.values.begin(), line.values.end(), drawable);
}

bool zero(const Line& line) {
  return std::none_of(line.values.begin(), line.values.end(),
                      [](double value) { return std::abs(value) > 0; });
}

bool has_nothing(const Chart& chart) {
  return std::all_of(chart.lines.begin(), chart.lines.end(), [&](const Line& line) {
    return chart.drawn == Drawn::unless_zero && zero(line);
  });
}

/// The indices from begin to end that are drawn, as far as they exist.
std::set<std::size_t> telling_places(const std::vector<double>& values, std::size_t begin,
                                     std::size_t end) {
  std::optional<std::size_t> low, high, gap;
  for (std::size_t i = begin; i < end; ++i) {
    if (!drawable(values[i])) {
      gap = i;
      continue;
    }
    if (!low || values[i] < values[*low]) low = i;
    if (!high || values[i] > values[*high]) high = i;
  }
  std::set<std::size_t> places;
  for (const auto& place : {low, high, gap})
    if (place) places.insert(*place);
  return places;
}

}  // namespace

std::span<const ChartPlan> chart_plans() {
  static const auto plans = make_plans();
  return plans;
}

std::span<const std::string_view> headline_metrics() {
  static constexpr std::array<std::string_view, 8> names = {
      "pose_error_far_rms", "volume_error",     "broken_neighbors", "J_min",
      "strain_99",          "displacement_max", "speed_max",        "twist_jump_max"};
  return names;
}

std::vector<double> shown_values(const ChartPlan& plan, std::string_view metric,
                                 std::span<const FrameMetrics> frames, double radius) {
  const auto value = metrics_table()[metric_index(metric)].value;
  std::vector<double> values;
  for (const FrameMetrics& frame : frames)
    values.push_back(shown_value(plan, frame.*value, frames.front().*value, radius));
  return values;
}

Chart planned_chart(const ChartPlan& plan, std::span<const FrameMetrics> frames, double radius) {
  Chart chart{std::string(plan.title),
              std::string(plan.note),
              std::string(plan.unit),
              plan.baselines,
              plan.span,
              plan.drawn,
              {},
              plan.topic};
  for (const auto& [metric, words] : plan.metrics)
    chart.lines.push_back({std::string(words), shown_values(plan, metric, frames, radius)});
  return chart;
}

double largest_change(const Chart& chart) {
  double change = 0;
  for (const Line& line : chart.lines) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const double value : line.values)
      if (drawable(value)) low = std::min(low, value), high = std::max(high, value);
    if (high > low) change = std::max(change, high - low);
  }
  return change;
}

bool says_something(const Chart& chart) {
  constexpr double rounding = 1e-6, telling = 1.0 / 20;
  double largest = 0;
  for (const Line& line : chart.lines)
    for (const double value : line.values)
      if (drawable(value)) largest = std::max(largest, std::abs(value));
  const double change = largest_change(chart);
  return change > rounding * largest && change >= telling * chart.span;
}

void leave_out_empty(std::vector<Chart>& charts) {
  for (Chart& chart : charts) std::erase_if(chart.lines, never_measured);
  std::erase_if(charts, has_nothing);
}

void put_in_order(std::vector<Chart>& charts) {
  std::stable_sort(charts.begin(), charts.end(),
                   [](const Chart& a, const Chart& b) { return a.topic < b.topic; });
  std::stable_partition(charts.begin(), charts.end(), says_something);
}

std::vector<std::size_t> drawn_indices(const std::vector<double>& values) {
  const std::size_t grain = values.size() <= max_drawn ? 1 : values.size() / (max_drawn / 3) + 1;
  std::vector<std::size_t> places;
  for (std::size_t begin = 0; begin < values.size(); begin += grain) {
    const auto kept = telling_places(values, begin, std::min(values.size(), begin + grain));
    places.insert(places.end(), kept.begin(), kept.end());
  }
  return places;
}

bool drawable(double value) { return std::abs(value) < 1e300; }

}  // namespace sinew

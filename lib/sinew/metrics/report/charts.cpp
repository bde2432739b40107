// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/report/charts.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <sinew/metrics/table.h>

namespace sinew {
namespace {

std::vector<ChartPlan> plans_of_shape() {
  return {
      {"Distance from the bones",
       "How far particles are from where their bones would carry them",
       "r",
       {"pose_error_rms", "pose_error_far_rms", "adherence_rms"},
       Shown::in_radii},
      {"Volume",
       "Relative to the body at rest: of the surface, and the mean around particles",
       "",
       {"volume_ratio", "J_mean"},
       Shown::as_is,
       {1}},
      {"Neighbors",
       "Pairs lost and won, as a share of the pairs at rest",
       "%",
       {"broken_neighbors", "new_neighbors", "broken_bonds"},
       Shown::in_percent},
      {"Tip",
       "Turn of the last bone's outermost particles, and of the bone that turns most",
       "degrees",
       {"tip_angle", "bone_angle"}},
      {"Twist from half-plane to half-plane",
       "A cut body shows its whole angle in one step",
       "degrees",
       {"twist_jump_max"}},
      {"Sections across the bones",
       "Largest loss of area (candy wrapper) and largest gain (bulge)",
       "%",
       {"candy_wrapper", "bulge"},
       Shown::in_percent},
  };
}

std::vector<ChartPlan> plans_of_material() {
  return {
      {"Smallest local volume",
       "Below zero the surroundings of a particle are inside out",
       "",
       {"J_min"},
       Shown::as_is,
       {0, 1}},
      {"Strain",
       "Equivalent strain that half, 95 % and 99 % of the particles do not exceed",
       "",
       {"strain_50", "strain_95", "strain_99"}},
      {"Stress", "Von Mises, that 95 % of the particles do not exceed", "Pa", {"von_mises_95"}},
      {"Inverted particles", "How many of them there are", "", {"inverted"}},
  };
}

std::vector<ChartPlan> plans_of_surface() {
  return {
      {"Surface", "Its area against the one at rest", "", {"area_ratio"}, Shown::as_is, {1}},
      {"Self-intersections", "Pairs of faces that cut each other", "", {"self_intersections"}},
      {"Surface and other poses: farthest",
       "From the rigid pose, linear-blend and dual-quaternion skinning, and a reference",
       "r",
       {"pose_hausdorff", "lbs_hausdorff", "dqs_hausdorff", "reference_hausdorff"},
       Shown::in_radii},
      {"Surface and other poses: mean",
       "From the same, over the area",
       "r",
       {"pose_distance_mean", "lbs_distance_mean", "dqs_distance_mean", "reference_distance_mean"},
       Shown::in_radii},
  };
}

std::vector<ChartPlan> plans_of_motion() {
  return {
      {"Displacement",
       "From the places at rest",
       "r",
       {"displacement_rms", "displacement_max"},
       Shown::in_radii},
      {"Speed", "Of the fastest particle", "m/s", {"speed_max"}},
      {"Energies",
       "Change since the first frame",
       "J",
       {"kinetic_energy", "pair_energy", "bone_energy", "gravity_energy", "work_of_bones",
        "dissipation"},
       Shown::since_start},
      {"World",
       "Energy of contacts with obstacles, and the work of all that is around the body, since the "
       "first frame",
       "J",
       {"contact_energy", "work_of_world"},
       Shown::since_start,
       {0},
       Drawn::unless_zero},
      {"Balance of energies",
       "What is missing; zero for a perfect integrator",
       "J",
       {"energy_residual"}},
  };
}

std::vector<ChartPlan> make_plans() {
  std::vector<ChartPlan> all;
  for (auto* plans : {plans_of_shape, plans_of_material, plans_of_surface, plans_of_motion})
    for (ChartPlan& plan : plans()) all.push_back(std::move(plan));
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

/// A line that was never measured only takes room in the legend; one stays in any case.
void drop_unmeasured(Chart& chart) {
  const auto unmeasured = [](const Line& line) {
    return std::none_of(line.values.begin(), line.values.end(), drawable);
  };
  const auto first = std::find_if_not(chart.lines.begin(), chart.lines.end(), unmeasured);
  if (first == chart.lines.end())
    chart.lines.resize(1);
  else
    std::erase_if(chart.lines, unmeasured);
}

}  // namespace

std::span<const ChartPlan> chart_plans() {
  static const auto plans = make_plans();
  return plans;
}

std::span<const std::string_view> telling_metrics() {
  static constexpr std::array<std::string_view, 8> names = {
      "pose_error_far_rms", "volume_error",     "broken_neighbors", "J_min",
      "strain_99",          "displacement_max", "speed_max",         "twist_jump_max"};
  return names;
}

bool is_drawn(const ChartPlan& plan, std::span<const FrameMetrics> frames) {
  if (plan.drawn == Drawn::always) return true;
  return std::any_of(plan.metrics.begin(), plan.metrics.end(), [&](std::string_view name) {
    const auto value = metrics_table()[metric_index(name)].value;
    return std::any_of(frames.begin(), frames.end(),
                       [&](const FrameMetrics& frame) { return std::abs(frame.*value) > 0; });
  });
}

Chart planned_chart(const ChartPlan& plan, std::span<const FrameMetrics> frames, double radius) {
  Chart chart{std::string(plan.title),
              std::string(plan.note),
              std::string(plan.unit),
              {},
              {},
              plan.baselines,
              {}};
  for (const FrameMetrics& frame : frames) {
    chart.times.push_back(frame.time);
    chart.angles.push_back(frame.bone_angle);
  }
  for (const std::string_view name : plan.metrics) {
    const auto value = metrics_table()[metric_index(name)].value;
    Line line{std::string(name), {}};
    for (const FrameMetrics& frame : frames)
      line.values.push_back(shown_value(plan, frame.*value, frames.front().*value, radius));
    chart.lines.push_back(std::move(line));
  }
  drop_unmeasured(chart);
  return chart;
}

}  // namespace sinew

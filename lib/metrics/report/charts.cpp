// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/report/charts.h"

#include <array>

#include "metrics/table.h"

namespace sinew {
namespace {

std::vector<ChartPlan> make_plans() {
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
      {"Neighbours",
       "Pairs lost and won, as a share of the pairs at rest",
       "%",
       {"broken_neighbours", "new_neighbours"},
       Shown::in_percent},
      {"Tip",
       "Turn of the last bone's outermost particles, and of the bone that turns most",
       "degrees",
       {"tip_angle", "bone_angle"}},
      {"Twist from half-plane to half-plane",
       "A cut body shows its whole angle in one step",
       "degrees",
       {"twist_jump_max"}},
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
      {"Surface", "Its area against the one at rest", "", {"area_ratio"}, Shown::as_is, {1}},
      {"Inverted particles", "How many of them there are", "", {"inverted"}},
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
      {"Balance of energies",
       "What is missing; zero for a perfect integrator",
       "J",
       {"energy_residual"}},
  };
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

}  // namespace

std::span<const ChartPlan> chart_plans() {
  static const auto plans = make_plans();
  return plans;
}

std::span<const std::string_view> telling_metrics() {
  static constexpr std::array<std::string_view, 8> names = {
      "pose_error_far_rms", "volume_error",     "broken_neighbours", "J_min",
      "strain_99",          "displacement_max", "speed_max",         "twist_jump_max"};
  return names;
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
  return chart;
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/summary.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "metrics/table.h"

namespace sinew {
namespace {

constexpr double same_turn = 0.1;    // degrees up to which a bone counts as back at rest
constexpr double same_shift = 1e-3;  // radii, likewise for its head

/// How bad a value is: larger is worse.
double badness(const Metric& metric, double value) {
  if (metric.worse == Worse::smaller) return -value;
  return metric.worse == Worse::magnitude ? std::abs(value) : value;
}

MetricSummary summary_of(const Metric& metric, std::span<const FrameMetrics> frames) {
  Statistics values;
  MetricSummary out;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const double value = frames[i].*metric.value;
    if (std::isnan(value)) continue;
    values.add(value);
    if (!out.worst_frame ||
        badness(metric, value) > badness(metric, frames[*out.worst_frame].*metric.value))
      out.worst_frame = i;
  }
  out.min = values.min();
  out.max = values.max();
  out.mean = values.mean();
  out.final = frames.back().*metric.value;
  return out;
}

bool at_rest(const FrameMetrics& frame, double radius) {
  return frame.bone_angle < same_turn && frame.bone_shift < same_shift * radius;
}

double residual_after_return(std::span<const FrameMetrics> frames, double radius) {
  const bool left = std::any_of(frames.begin(), frames.end(), [&](const FrameMetrics& frame) {
    return !std::isnan(frame.bone_angle) && !at_rest(frame, radius);
  });
  return left && at_rest(frames.back(), radius) ? frames.back().displacement_rms : not_measured;
}

/// How far the tip's turn goes beyond its last value in a hold, on the side it did not come from.
double overshoot_of(const Hold& hold, std::span<const FrameMetrics> frames) {
  if (hold.first == 0) return not_measured;  // it came from nowhere
  const auto tip = [&](std::size_t i) { return frames[i].tip_angle; };
  const double end = tip(hold.last), before = tip(hold.first - 1);
  const double way = end > before ? 1 : -1;
  Statistics beyond;
  for (std::size_t i = hold.first; i <= hold.last; ++i)
    if (!std::isnan(tip(i) - before)) beyond.add(way * (tip(i) - end));
  return beyond.count > 0 ? std::max(0.0, beyond.max()) : not_measured;
}

double largest_overshoot(std::span<const Hold> holds, std::span<const FrameMetrics> frames) {
  Statistics all;
  for (const Hold& hold : holds)
    if (const double over = overshoot_of(hold, frames); !std::isnan(over)) all.add(over);
  return all.max();
}

/// The largest distance of value(frame), a vector, from that of the first frame.
template <class Value>
double drift(std::span<const FrameMetrics> frames, const Value& value) {
  Statistics away;
  for (const FrameMetrics& frame : frames)
    if (const double d = (value(frame) - value(frames.front())).norm(); !std::isnan(d)) away.add(d);
  return away.max();
}

}  // namespace

Summary summarize(std::span<const FrameMetrics> frames, double radius, std::vector<Hold> holds) {
  if (frames.empty())
    throw bad_input("the run has no frames to measure", "let it write one frame at least");
  Summary summary;
  summary.frames = frames.size();
  for (const Metric& metric : metrics_table())
    summary.metrics.push_back(summary_of(metric, frames));
  summary.residual_rms = residual_after_return(frames, radius);
  Statistics settled;
  for (const Hold& hold : holds)
    if (!std::isnan(hold.settled)) settled.add(hold.settled);
  summary.settling_time = settled.max();
  summary.overshoot = largest_overshoot(holds, frames);
  summary.momentum_drift = drift(
      frames, [](const FrameMetrics& m) { return Vec3(m.momentum_x, m.momentum_y, m.momentum_z); });
  summary.angular_momentum_drift = drift(frames, [](const FrameMetrics& m) {
    return Vec3(m.angular_momentum_x, m.angular_momentum_y, m.angular_momentum_z);
  });
  summary.holds = std::move(holds);
  return summary;
}

void add_worst_particles(Summary& summary,
                         std::span<const std::vector<std::int64_t>> worst_particles) {
  for (std::size_t i = 0; i < summary.metrics.size(); ++i) {
    MetricSummary& metric = summary.metrics[i];
    if (!metric.worst_frame || worst_particles[*metric.worst_frame][i] < 0) continue;
    metric.worst_particle = static_cast<std::size_t>(worst_particles[*metric.worst_frame][i]);
  }
}

}  // namespace sinew

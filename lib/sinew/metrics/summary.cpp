// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/summary.h>

#include <algorithm>
#include <cmath>

#include <sinew/core/error.h>
#include <sinew/metrics/frame_metrics.h>
#include <sinew/metrics/markup.h>
#include <sinew/metrics/table.h>

namespace sinew {

namespace {

constexpr double still_turn = 0.01;   // degrees: less than a smooth motion turns in its first frame
constexpr double still_shift = 1e-3;  // radii
constexpr double settled_within = 0.2;    // radii
constexpr std::size_t fewest_frames = 3;  // with two there is nothing between start and end

bool still(const std::vector<RigidFrame>& from, const std::vector<RigidFrame>& to, double radius) {
  const PoseChange change = pose_change(from, to);
  return degrees(change.turn) <= still_turn && change.shift <= still_shift * radius;
}

double rms_distance(const Points& one, const Points& other) {
  return statistics(one.size(), [&](std::size_t i) { return (one[i] - other[i]).norm(); }).rms();
}

}  // namespace

std::vector<Hold> holds(std::span<const std::vector<RigidFrame>> bones, double radius) {
  std::vector<Hold> found;
  for (std::size_t first = 0; first < bones.size();) {
    std::size_t last = first;
    while (last + 1 < bones.size() && still(bones[first], bones[last + 1], radius)) ++last;
    if (last - first + 1 >= fewest_frames) found.push_back({first, last});
    first = last + 1;
  }
  return found;
}

double settling_time(const Hold& hold, std::span<const double> times, double radius,
                     const std::function<Points(std::size_t frame)>& positions) {
  const Points end = positions(hold.last);
  std::size_t settled = hold.last;
  while (settled > hold.first &&
         rms_distance(positions(settled - 1), end) < settled_within * radius)
    --settled;
  return times[settled] - times[hold.first];
}

namespace {

constexpr double same_turn = 0.1;    // degrees: a bone within this of its rest pose counts as back
constexpr double same_shift = 1e-3;  // radii, likewise for its head

/// The badness of a value: larger is worse.
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

/// Finds how far the tip overshoots its last angle in a hold, on the side opposite to its start.
double overshoot_of(const Hold& hold, std::span<const FrameMetrics> frames) {
  if (hold.first == 0) return not_measured;  // there is no earlier angle
  const auto tip = [&](std::size_t i) { return frames[i].tip_angle; };
  const double end = tip(hold.last), before = tip(hold.first - 1);
  const double direction = end > before ? 1 : -1;
  Statistics beyond;
  for (std::size_t i = hold.first; i <= hold.last; ++i)
    if (!std::isnan(tip(i) - before)) beyond.add(direction * (tip(i) - end));
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

namespace {

struct Scale {
  double good, fair;                 ///< the largest values that count as such
  std::array<const char*, 3> words;  ///< for good, fair, poor
};

// The values that the paper's body reaches in a good run are at the upper end of "fair" or below.
constexpr Scale volume_scale{
    0.02, 0.1, {"keeps its volume", "volume changes visibly", "collapses"}};
constexpr Scale pose_scale{2, 5, {"follows its bones", "lags behind its bones", "lost its bones"}};
constexpr Scale broken_scale{0.01, 0.05, {"stays in one piece", "flows a little", "breaks apart"}};
constexpr Scale inverted_scale{
    0.001, 0.01, {"hardly anything is inside out", "a few folds", "folds into itself"}};
constexpr Scale residual_scale{0.2, 1, {"returns to its shape", "keeps a trace", "stays deformed"}};
constexpr Scale limb_scale{
    5, 20, {"each limb turns with its bone", "a limb is turned a little off", "does not follow"}};

VerdictItem judged(const char* label, double value, const std::string& text, const Scale& scale) {
  VerdictItem item{label, text, "not measured", Level::unknown};
  if (std::isnan(value)) return item;
  item.level = value <= scale.good ? Level::good : value <= scale.fair ? Level::fair : Level::poor;
  item.meaning = scale.words[static_cast<std::size_t>(item.level)];
  return item;
}

std::string with_unit(double value, int decimals, const char* unit) {
  return std::isnan(value) ? fixed(value, 0) : fixed(value, decimals) + unit;
}

VerdictItem last_item(std::span<const FrameMetrics> frames, const Summary& summary, double radius) {
  if (is_frozen(frames, radius))
    return {"largest displacement",
            with_unit(summary.metrics[metric_index("displacement_max")].max / radius, 2, " r"),
            "frozen: its bones move nothing", Level::poor};
  const double residual = summary.residual_rms / radius;
  if (!std::isnan(residual))
    return judged("residual after the return, rms and maximum", residual,
                  fixed(residual, 2) + " r, " +
                      with_unit(frames.back().displacement_max / radius, 1, " r at most"),
                  residual_scale);
  const double off = frames.back().limb_turn_max;
  return judged("between a limb and its bone, at the end", off, with_unit(off, 1, "°"), limb_scale);
}

VerdictItem inverted_item(double particles_inverted, std::size_t particles) {
  const double share = particles_inverted / static_cast<double>(particles);
  VerdictItem item = judged("inverted particles, at a time", share,
                            with_unit(100 * share, share < 0.001 ? 3 : 2, " %"), inverted_scale);
  if (share == 0) item.value = "0", item.meaning = "nothing is inside out";
  return item;
}

}  // namespace

bool is_frozen(std::span<const FrameMetrics> frames, double radius) {
  return std::none_of(frames.begin(), frames.end(), [&](const FrameMetrics& frame) {
    const bool by_bones_alone = frame.work_of_world == 0 && !(std::abs(frame.gravity_energy) > 0);
    return !by_bones_alone || std::isnan(frame.bone_angle) || !(frame.displacement_max < radius);
  });
}

std::array<VerdictItem, 5> verdict(std::span<const FrameMetrics> frames, const Summary& summary,
                                   double radius, std::size_t particles) {
  const auto worst = [&](const char* name) { return summary.metrics[metric_index(name)].max; };
  const double volume = worst("volume_error"), pose = worst("pose_error_far_rms") / radius;
  const double inverted = worst("inverted"), bonds = worst("broken_bonds");
  const bool bonded = !std::isnan(bonds);
  const double broken = bonded ? bonds : worst("broken_neighbors");
  return {
      judged("volume error", volume, with_unit(100 * volume, 2, " %"), volume_scale),
      judged("from the rigid pose, away from joints", pose, with_unit(pose, 2, " r"), pose_scale),
      judged(bonded ? "broken bonds" : "broken neighbors", broken, with_unit(100 * broken, 2, " %"),
             broken_scale),
      inverted_item(inverted, particles), last_item(frames, summary, radius)};
}

std::string reasons_for_distrust(std::span<const FrameMetrics> frames, const Summary& summary,
                                 double radius, std::size_t particles) {
  constexpr double max_inverted = 0.01;  // fraction: inverted_scale calls more poor
  const auto items = verdict(frames, summary, radius, particles);
  const auto &volume = items[0], &pose = items[1];
  const double count = summary.metrics[metric_index("inverted")].max,
               fraction = count / static_cast<double>(particles);
  std::string reasons;
  const auto add = [&](bool holds, const std::string& reason) {
    if (holds) reasons += (reasons.empty() ? "" : ", ") + reason;
  };
  add(fraction > max_inverted,
      fixed(count, 0) + " of " + std::to_string(particles) + " particles are inverted");
  add(volume.level == Level::poor, "the volume is off by " + volume.value);
  add(pose.level == Level::poor, "the body is " + pose.value + " from the pose of its bones");
  add(is_frozen(frames, radius), "its bones move no particle by a radius");
  return reasons;
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// A run as a whole: extremes of every metric, what stays after the return, and how soon it settles.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <sinew/core/vector.h>
#include <sinew/metrics/frame.h>

namespace sinew {

/// Of one metric over the frames in which it was measured; not-a-number when it never was.
struct MetricSummary {
  double min = not_measured, max = not_measured, mean = not_measured;
  double final = not_measured;  ///< in the last frame
  std::optional<std::size_t>
      worst_frame;  ///< the first with the worst value; Metric::worse says which
  std::optional<std::size_t> worst_particle;  ///< that has it, in the written order
};

/// A time in which no bone moves.
struct Hold {
  std::size_t first = 0, last = 0;  ///< frames
  double settled = not_measured;    ///< s after its start; see settling.h
};

struct Summary {
  std::size_t frames = 0;
  std::vector<MetricSummary> metrics;   ///< in the order of metrics_table()
  double residual_rms = not_measured;   ///< m; unit, meaning and formula in run_metrics_table()
  double settling_time = not_measured;  ///< s
  double overshoot = not_measured;      ///< degrees
  double momentum_drift = not_measured, angular_momentum_drift = not_measured;  ///< SI
  std::vector<Hold> holds;
};

/// Sums the frames up (in order of time, one at least, else bad input). `holds` with their settling
/// times come from settling.h where the positions are at hand. `radius`: of a particle, m.
Summary summarize(std::span<const FrameMetrics> frames, double radius,
                  std::vector<Hold> holds = {});

/// Adds the particles that have the worst values. worst_particles: of every frame, see measure.h.
void add_worst_particles(Summary& summary,
                         std::span<const std::vector<std::int64_t>> worst_particles);

// How soon the body comes to rest once its bones do.

/// The longest stretches of three frames or more in which no bone turns by more than 0.01 degrees
/// or shifts by more than 1e-3 r from where it was at the stretch's start. bones: a pose per frame.
std::vector<Hold> holds(std::span<const std::vector<RigidFrame>> bones, double radius);

/// The time (s) from the hold's start after which the rms distance of the particles to their places
/// in its last frame stays below 0.2 r. Frames are asked for backwards from the last, two in
/// memory.
double settling_time(const Hold& hold, std::span<const double> times, double radius,
                     const std::function<Points(std::size_t frame)>& positions);

// What a run amounts to, in five numbers and a few words.

enum class Level { good, fair, poor, unknown };

struct VerdictItem {
  std::string label, value, meaning;  ///< plain text
  Level level = Level::unknown;
};

/// Volume error, distance from the rigid pose far from joints, broken neighbors, inverted
/// particles, and the residual after the return or else the turn of the tip. Worst frame each, the
/// last two at the end. radius in m.
std::array<VerdictItem, 5> verdict(std::span<const FrameMetrics> frames, const Summary& summary,
                                   double radius);

}  // namespace sinew

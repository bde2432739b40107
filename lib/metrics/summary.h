// SPDX-License-Identifier: GPL-3.0-or-later
// A run as a whole: extremes of every metric, what stays after the return, and how soon it settles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "metrics/frame.h"

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

}  // namespace sinew

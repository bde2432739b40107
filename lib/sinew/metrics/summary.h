// SPDX-License-Identifier: GPL-3.0-or-later
// Summary of a run: extremes of every metric, the residual after the return, the settling time, and
// the verdict.
//
//     const Summary summary = summarize(frames, radius);
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

/// Values of one metric over the frames in which it was measured; not-a-number when it never was.
struct MetricSummary {
  double min = not_measured, max = not_measured, mean = not_measured;
  double final = not_measured;  ///< in the last frame
  /// First frame with the worst value; Metric::worse says which that is.
  std::optional<std::size_t> worst_frame;
  std::optional<std::size_t> worst_particle;  ///< particle that has it, in the written order
};

/// A time in which no bone moves.
struct Hold {
  std::size_t first = 0, last = 0;  ///< frames
  double settled = not_measured;    ///< s after its start; see settling_time()
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

/// Summarizes frames in order of time; throws bad input where there are none. `holds` come with
/// their settling times, see below. `radius`: of a particle, m.
Summary summarize(std::span<const FrameMetrics> frames, double radius,
                  std::vector<Hold> holds = {});

/// Adds the particles with the worst values. worst_particles: of every frame, see MeasuredFrame.
void add_worst_particles(Summary& summary,
                         std::span<const std::vector<std::int64_t>> worst_particles);

// Settling: how soon the body comes to rest once its bones do.

/// The longest intervals of three frames or more in which no bone turns by more than 0.01 degrees
/// or shifts by more than 1e-3 r from its pose at the interval's start. bones: a pose per frame.
std::vector<Hold> holds(std::span<const std::vector<RigidFrame>> bones, double radius);

/// The time (s) from the hold's start after which the rms distance of the particles to their
/// positions in its last frame stays below 0.2 r. Frames are requested backward from the last; two
/// are in memory.
double settling_time(const Hold& hold, std::span<const double> times, double radius,
                     const std::function<Points(std::size_t frame)>& positions);

// The verdict: five numbers that characterize a run, each with a level and a few words.

enum class Level { good, fair, poor, unknown };

struct VerdictItem {
  std::string label, value, meaning;  ///< plain text
  Level level = Level::unknown;
};

/// Volume error, distance from the rigid pose far from joints, broken neighbors, inverted
/// particles, and the residual after the return or else the limb that is turned farthest from its
/// bone: each in its worst frame, the last at the end. Of a body with bones that nothing moves:
/// that, in its place. radius in m.
std::array<VerdictItem, 5> verdict(std::span<const FrameMetrics> frames, const Summary& summary,
                                   double radius, std::size_t particles);

/// Whether there are bones, nothing else acts in time, and no particle has moved by a radius.
bool is_frozen(std::span<const FrameMetrics> frames, double radius);

/// Why a run of so many particles is not to be trusted, in one line: over a hundredth of them
/// inverted at a time, a volume or a distance from the rigid pose that the verdict calls poor. ""
/// where there is no reason.
std::string reasons_for_distrust(std::span<const FrameMetrics> frames, const Summary& summary,
                                 double radius, std::size_t particles);

}  // namespace sinew

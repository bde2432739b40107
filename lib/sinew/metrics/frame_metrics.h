// SPDX-License-Identifier: GPL-3.0-or-later
// Measures one frame against the body at rest. table.cpp gives the meaning of each number.
//
//     const RestBody rest = rest_body(input);
//     const FrameMetrics metrics = measure(rest, state);
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <sinew/metrics/frame.h>
#include <sinew/metrics/particle_values.h>
#include <sinew/metrics/rest_body.h>

namespace sinew {

/// All metrics of a frame, in parallel, the same bits for any number of threads. Frames are
/// independent of each other. Metrics that do not apply (those of bones where there are none) are
/// not-a-number. Throws bad input for a frame of another body or with a number that is not finite.
FrameMetrics measure(const RestBody& rest, const FrameState& state);

/// The same, with the particle values it is computed from.
struct MeasuredFrame {
  FrameMetrics metrics;
  ParticleValues particles;
  /// For each of metrics_table() the particle (written order) that has its value, the first of
  /// several; -1 where it does not belong to a particle.
  std::vector<std::int64_t> worst_particles;
};
MeasuredFrame measure_frame(const RestBody& rest, const FrameState& state);

/// The largest turn (rad) and shift of a head (m) of any bone from one pose to another.
struct PoseChange {
  double turn = 0, shift = 0;
};
PoseChange pose_change(std::span<const RigidFrame> from, std::span<const RigidFrame> to);

}  // namespace sinew

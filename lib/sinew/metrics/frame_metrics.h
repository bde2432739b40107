// SPDX-License-Identifier: GPL-3.0-or-later
// Measures one frame against the body at rest. What each number means stands in table.cpp.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <sinew/metrics/frame.h>
#include <sinew/metrics/particle_values.h>
#include <sinew/metrics/rest_body.h>

namespace sinew {

/// All metrics of a frame, in parallel, the same bits for any number of threads. Frames are
/// measured each by itself, in any order. What has nothing to be measured on (a bone's metrics
/// without bones) is not-a-number. Throws bad input for a frame of another body or with a number
/// that is not finite.
FrameMetrics measure(const RestBody& rest, const FrameState& state);

/// The same, with what it rests on.
struct MeasuredFrame {
  FrameMetrics metrics;
  ParticleValues particles;
  /// For each of metrics_table() the particle (written order) that has its value, the first of
  /// several; -1 where it belongs to no one particle.
  std::vector<std::int64_t> worst_particles;
};
MeasuredFrame measure_frame(const RestBody& rest, const FrameState& state);

/// The largest turn (rad) and shift of a head (m) of any bone from one pose to another.
struct PoseChange {
  double turn = 0, shift = 0;
};
PoseChange pose_change(std::span<const RigidFrame> from, std::span<const RigidFrame> to);

}  // namespace sinew

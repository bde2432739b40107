// SPDX-License-Identifier: GPL-3.0-or-later
// metrics_bones.csv: how well the particles of each bone follow it, a row per frame and bone.
//
//     const auto rows = measure_bones(rest, state, particle_values(rest, state));
//     write_file("metrics_bones.csv", bone_metrics_csv(rows));
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sinew/metrics/frame.h>
#include <sinew/metrics/particle_values.h>
#include <sinew/metrics/rest_body.h>

namespace sinew {

/// Metrics of the particles that follow one bone most; not-a-number where there are none.
struct BoneMetrics {
  double time = not_measured, bone = not_measured, followers = 0;
  double adherence_rms = not_measured, adherence_95 = not_measured, adherence_max = not_measured;
  double adherence_joint_rms = not_measured, adherence_far_rms = not_measured;
  double radial_mean = not_measured, twist_rms = not_measured, twist_mean = not_measured;
  double pose_error_rms = not_measured, pose_error_max = not_measured;
  double turn_error = not_measured;
  double volume = not_measured, volume_ratio = not_measured;
  double volume_joint_ratio = not_measured, volume_far_ratio = not_measured;
};

struct BoneMetric {
  std::string_view name, unit, help, formula;
  double BoneMetrics::*value;
};

std::span<const BoneMetric> bone_metrics_table();

/// One for each bone, in their order. The state must be one of this body, `particles` its values.
std::vector<BoneMetrics> measure_bones(const RestBody& rest, const FrameState& state,
                                       const ParticleValues& particles);

/// The whole file, in the format of metrics_csv().
std::string bone_metrics_csv(std::span<const BoneMetrics> rows);

}  // namespace sinew

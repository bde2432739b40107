// SPDX-License-Identifier: GPL-3.0-or-later
#include "draw/run_shot.h"

#include <cmath>

#include "core/number_text.h"

namespace sinew {

Shot shot_of(const RunFiles& run, RunFrame frame, double angle) {
  Shot shot;
  shot.caption = three_digits(frame.time) + " s,  " +
                 std::to_string(static_cast<int>(std::lround(degrees(angle)))) + "\u00b0";
  shot.particles = std::move(frame.positions);
  shot.radius = run.body.particles.radius;
  shot.values = std::move(frame.displacement);
  shot.surface = {std::move(frame.surface_points), run.surface.faces};
  for (std::size_t b = 0; b < frame.bones.size(); ++b) {
    const RigidFrame& bone = frame.bones[b];
    const Vec3 tail = bone.origin + frame.bone_lengths[b] * bone.rotation.col(0);
    shot.bones.push_back({bone.origin, tail, bone.rotation});
  }
  return shot;
}

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// Slows particles that were too fast in a step, relative to their bones.
//
//     const SpeedChange change = slowed(body, pose, particles, forces, stepping, offenders, 0.2);
//     velocities += change.gain;
#pragma once

#include <cstddef>
#include <vector>

#include <sinew/body/body.h>
#include <sinew/body/forces.h>
#include <sinew/body/step_plan.h>
#include <sinew/stepping/stepper.h>

namespace sinew {

struct SpeedChange {
  Points gain;                         ///< of each particle, by place, m/s
  std::vector<std::size_t> particles;  ///< that are slowed, by place
  Vec3 impulse = Vec3::Zero();         ///< of their bones on them, N s
  double work = 0;                     ///< of the bones by it, J
};

/// What makes each offender move by `radii` radii in a step that begins with these velocities and
/// forces. Those without a bone, and those that are not finite, stay as they are.
SpeedChange slowed(const Body& body, const Pose& pose, const Particles& particles,
                   const Forces& forces, const Stepping& stepping,
                   const std::vector<Offender>& offenders, double radii);

}  // namespace sinew

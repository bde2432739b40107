// SPDX-License-Identifier: GPL-3.0-or-later
// Changes of velocities beside steps: particles that were too fast in one, relative to their bones,
// are slowed.
//
//     const SpeedChange change = slowed(body, pose, particles, forces, stepping, offenders, 0.2);
//     velocities += change.gain;
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <sinew/body/body.h>
#include <sinew/body/forces.h>
#include <sinew/body/step_plan.h>
#include <sinew/stepping/stepper.h>

namespace sinew {

struct SpeedChange {
  Points gain;                         ///< gain in each particle's velocity, by place, m/s
  std::vector<std::size_t> particles;  ///< particles that are slowed, by place
  Vec3 impulse = Vec3::Zero();         ///< impulse of their bones on them, N s
  double work = 0;                     ///< work of the bones by it, J
};

/// What makes each offender move by `radii` radii in a step that begins with these velocities and
/// forces. Those without a bone, and those that are not finite, stay as they are.
SpeedChange slowed(const Body& body, const Pose& pose, const Particles& particles,
                   const Forces& forces, const Stepping& stepping,
                   const std::vector<Offender>& offenders, double radii);

/// Adds so many times `gain`, of a particle by place (m/s), to the velocities of a state;
/// `unit_of_time` (s): theirs in single precision.
void add_to_velocities(SimulationState& state, double by, double unit_of_time,
                       const std::function<Vec3(std::size_t i)>& gain);

}  // namespace sinew

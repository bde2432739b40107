// SPDX-License-Identifier: GPL-3.0-or-later
// Why a particle moved too far in a step, in words, and what helps.
//
//     throw unstable({body, pose, time, particles, forces, stepping, steps}, particle, true);
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <sinew/body/body.h>
#include <sinew/body/forces.h>
#include <sinew/body/step_plan.h>
#include <sinew/core/error.h>

namespace sinew {

/// The moment before a step that failed.
struct FailedStep {
  const Body& body;
  const Pose& pose;
  double time;                 ///< s
  const Particles& particles;  ///< before the step
  const Forces& forces;        ///< there
  const Stepping& stepping;
  std::int64_t steps = 0;  ///< before it
};

/// Whether the particle (by place) did it because of a step over the limit of the body at rest, or
/// of gravity that no stiffness bears: it is for the scene to mend, not for shorter steps.
bool is_of_all_steps(const FailedStep& failed, std::size_t particle);

/// "cause; cure" of what one of the particles (by place) did: gravity, a bone that is too fast or
/// has left it, an obstacle, fields or muscles, else a step that is too long. The cure names a step
/// where a shorter one helps.
std::string cause_and_cure(const FailedStep& failed, std::size_t particle);

/// The same as an error that names step, time, particle and bone; `finite`: it moved too far, else
/// it reached a value that is not finite.
Error unstable(const FailedStep& failed, std::size_t particle, bool finite);

}  // namespace sinew

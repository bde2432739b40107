// SPDX-License-Identifier: GPL-3.0-or-later
// A body that begins in the first pose of its motion rather than at rest: skinned by dual
// quaternions, and relaxed on bones that stand still.
//
//     if (begin_of(settings, body, motion).posed) first = posed(body, motion, rest, solver);
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include <sinew/body/body.h>
#include <sinew/core/particles.h>
#include <sinew/rig/motion.h>
#include <sinew/settings/settings.h>

namespace sinew {

/// What comes of motion.begin.
struct Beginning {
  bool posed = false;  ///< whether the body begins in the first pose
  std::string why;     ///< in a line; "" where nobody has to know
};

/// Whether a bone is turned by over 90 degrees where a clip starts, or jumps from rest in a frame.
bool begins_far_from_rest(const Skeleton& skeleton, Motion clip);

/// Decides it for a body, and starts the motion there: without preroll, and with the second key
/// where the first is the rest pose and the second is not. Throws bad input, with the scene's line,
/// for a first pose with a preroll, and with what knows the rest state alone.
Beginning begin_of(const Settings& settings, const Body& body, Motion& motion);

/// Hears how many iterations a relaxation took so far, and how far it is from rest.
using RelaxationProgress = std::function<void(std::int64_t iterations, double residual)>;

/// The particles (at rest) in the pose at time 0, at rest there as far as that takes not too long,
/// with the velocities of their bones.
Particles posed(const Body& body, const Motion& motion, const Particles& particles,
                const SolverSettings& solver, const RelaxationProgress& progress = {});

}  // namespace sinew

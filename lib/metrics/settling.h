// SPDX-License-Identifier: GPL-3.0-or-later
// How soon the body comes to rest once its bones do.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/rigid.h"
#include "core/vector.h"
#include "metrics/summary.h"

namespace sinew {

/// The longest stretches of three frames or more in which no bone turns by more than 0.01 degrees
/// or shifts by more than 1e-3 r from where it was at the stretch's start. bones: a pose per frame.
std::vector<Hold> holds(std::span<const std::vector<RigidFrame>> bones, double radius);

/// The time (s) from the hold's start after which the rms distance of the particles to their places
/// in its last frame stays below 0.2 r. Frames are asked for backwards from the last, two in
/// memory.
double settling_time(const Hold& hold, std::span<const double> times, double radius,
                     const std::function<Points(std::size_t frame)>& positions);

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// What is doubtful in a scene that may be run all the same.
#pragma once

#include <string>
#include <vector>

#include "scene/setup.h"
#include "scene/step_way.h"

namespace sinew {

/// Each a line with the number, the reason and the cure. `bone_speed` in radii per step.
std::vector<std::string> warnings_of(const Setup& setup, const SolverSettings& solver,
                                     double bone_speed);

}  // namespace sinew

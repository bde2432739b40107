// SPDX-License-Identifier: GPL-3.0-or-later
// What is doubtful in a scene that can be run all the same.
//
//     for (const std::string& warning : warnings_of(prepared, speed)) print(warning);
#pragma once

#include <string>
#include <vector>

#include <sinew/scene/prepare.h>

namespace sinew {

/// One line each, with the number, the reason and the cure. `surface`: of the body; `bone_speed` in
/// radii per step.
std::vector<std::string> warnings_of(const Prepared& prepared, double bone_speed);

/// The same with those of its stiffness, its filling and the memory that it needs: all that is
/// known without a step.
std::vector<std::string> warnings_before_trials(const Prepared& prepared, double bone_speed);

/// Sorts warnings by their length, each once.
void shortest_first(std::vector<std::string>& warnings);

/// Adds a line where the body is one or two layers of particles thick, where limbs touch at rest
/// across a gap of the mesh, and where limbs that do not belong together meet in the motion of a
/// material that sticks to itself.
void warn_of_contacts(const Prepared& prepared, std::vector<std::string>& warnings);

/// One line for each choice without which the run would take less than a third of its steps: what
/// it is, how often, and the cure.
std::vector<std::string> costly_choices(const Prepared& prepared);

}  // namespace sinew

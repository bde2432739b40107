// SPDX-License-Identifier: GPL-3.0-or-later
// The stepper that a run uses.
//
//     const StepperChoice choice = stepper_choice(settings.solver);
#pragma once

#include <string>

#include <sinew/physics/kernel/kernel.h>
#include <sinew/settings/settings.h>

namespace sinew {

struct StepperChoice {
  NeighborSearch search = NeighborSearch::lists;
  Precision precision = Precision::binary64;
  kernel::InstructionSet instructions = kernel::best_instruction_set();
};

/// The cell stepper has one precision, double, and no vector instructions.
StepperChoice stepper_choice(const SolverSettings& solver);

/// As the scene's keys spell them.
const char* name_of(NeighborSearch search);
const char* name_of(Precision precision);

/// Typical particle-steps per second on one core.
double usual_speed(const StepperChoice& choice);

}  // namespace sinew

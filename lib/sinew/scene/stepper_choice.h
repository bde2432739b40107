// SPDX-License-Identifier: GPL-3.0-or-later
// The stepper that a run uses; a scene's solver section decides it only in part.
//
//     const StepperChoice choice = stepper_choice(settings.solver, body, motion);
#pragma once

#include <optional>
#include <string>

#include <sinew/physics/forces.h>
#include <sinew/physics/kernel/kernel.h>
#include <sinew/rig/motion.h>
#include <sinew/settings/settings.h>

namespace sinew {

/// A setting that the list stepper does not support, and the value that it does.
struct Unsupported {
  std::string key, value, supported;
};

struct StepperChoice {
  NeighborSearch search = NeighborSearch::lists;
  Precision precision = Precision::binary64;
  kernel::InstructionSet instructions = kernel::best_instruction_set();
  std::optional<Unsupported> unsupported{};  ///< why cells replace the requested lists
};

/// The cell stepper has one precision, double, and no vector instructions.
StepperChoice stepper_choice(const SolverSettings& solver, const Body& body, const Motion& motion);

/// As the scene's keys spell them.
const char* name_of(NeighborSearch search);
const char* name_of(Precision precision);

/// Typical particle-steps per second on one core.
double usual_speed(const StepperChoice& choice);

/// How many times slower than lists in the scene's precision cells typically are.
double slowness_of_cells(Precision precision);

}  // namespace sinew

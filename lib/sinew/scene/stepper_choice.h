// SPDX-License-Identifier: GPL-3.0-or-later
// How the steps of a run are really done, which a scene's solver section decides only in part.
#pragma once

#include <optional>
#include <string>

#include <sinew/physics/forces.h>
#include <sinew/physics/kernel/kernel.h>
#include <sinew/rig/motion.h>
#include <sinew/settings/settings.h>

namespace sinew {

/// A setting that the lists know nothing of, and the choice of it that they know.
struct Unsupported {
  std::string key, value, supported;
};

struct StepperChoice {
  NeighborSearch search = NeighborSearch::lists;
  Precision precision = Precision::binary64;
  kernel::InstructionSet instructions = kernel::best_instruction_set();
  std::optional<Unsupported> unsupported{};  ///< why cells take the place of the lists asked for
};

/// Cells know one precision, double, and no instruction set but the plain one.
StepperChoice stepper_choice(const SolverSettings& solver, const Body& body, const Motion& motion);

/// As the scene's keys spell them.
const char* name_of(NeighborSearch search);
const char* name_of(Precision precision);

/// Particle-steps per second that one core is usually seen to make.
double usual_speed(const StepperChoice& choice);

/// How many times slower than lists in the scene's precision cells usually are.
double slowness_of_cells(Precision precision);

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// Sums over a body, once a step: what the kernel has added up for each piece in SI units, and the
// energies of particles at a moment.
//
//     StepSums sums = sums_of(totals, units, mass);
#pragma once

#include <span>

#include <sinew/body/ledger.h>
#include <sinew/body/step_plan.h>
#include <sinew/core/energies.h>
#include <sinew/core/particles.h>
#include <sinew/kernel/kernel.h>
#include <sinew/lists/block_state.h>
#include <sinew/stepping/stepper.h>

namespace sinew {

/// Power and losses of the kernel's forces, W; `mass` (kg): of a particle of the material's
/// density. In the pieces' order, whichever thread made them.
StepSums sums_of(std::span<const kernel::Totals> pieces, const Units& units, double mass);

/// How far the forces of the kernel are from equilibrium, with half of what they pull as applied.
Imbalance imbalance_of(std::span<const kernel::Totals> pieces, const Units& units, double mass);

/// A moment of a body whose energies are asked for.
struct EnergyMoment {
  const Body& body;
  const Particles& now;
  const Forces& forces;
  const Balance& balance;
  const Stepping& stepping;  ///< with the step made last
};

/// Energies of the moment, without work and losses since the start. In parallel; the same bits for
/// any number of threads.
Energies energies_at(const EnergyMoment& moment);

}  // namespace sinew

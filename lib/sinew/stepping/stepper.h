// SPDX-License-Identifier: GPL-3.0-or-later
// What every stepper offers to Simulation: see lists/list_stepper.h and reference/cell_stepper.h.
//
//     const StepSums sums = stepper.step(pose);
//     ledger.add_step(sums.power, sums.lost);
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace sinew {

/// A particle whose motion in a step is invalid, by its place in the caller's order.
struct Offender {
  std::size_t particle = 0;
  bool finite = true;
  double moved = 0;  ///< relative to its bone, m; 0 where that is not finite
};

/// A step that was rejected.
struct Failure {
  Offender first;  ///< the one with the lowest place
  std::vector<Offender> all;
};

/// How far from equilibrium a body is at the positions that a step began with: sums over what is
/// free to move.
struct Imbalance {
  double aa = 0, av = 0, vv = 0;  ///< of accelerations a and velocities v, m^2/s^4 to m^2/s^2
  double flowing = 0;             ///< energy lost to bonds that flow or break, W
  double unbalanced = 0;  ///< the lengths of all forces on particles that nothing answers, N
  /// The largest of these, N: the lengths of all forces of loads, obstacles and (half) pins; the
  /// weight; half those of bones and fibers; a support's force, and its moment over the extent.
  double applied = 0;
  double loaded = 0;  ///< of it, by loads and the weight alone: exactly 0 without
};

/// Contributions of a step to the ledger, at the moment of the positions it began with.
struct StepSums {
  double power = 0;  ///< of the bones, W
  double lost = 0;   ///< to damping, drag and friction, W
  std::optional<Failure> failure;
  double world_power = 0;   ///< of moving obstacles, fields, muscles and pins, W
  double held_kinetic = 0;  ///< of particles that pins hold, J
  Imbalance imbalance;      ///< only of steps that relax
};

/// The ledger at one moment.
struct Balance {
  double power = 0, lost = 0;               ///< W
  double pair_energy = 0, bone_energy = 0;  ///< J
  double world_power = 0;                   ///< W
  double contact_energy = 0;                ///< in the springs of obstacles, J
  double held_kinetic = 0;                  ///< of particles that pins hold, J
};

}  // namespace sinew

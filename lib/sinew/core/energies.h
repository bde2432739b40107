// SPDX-License-Identifier: GPL-3.0-or-later
// The ledger of a body's energy, and what forces leave unanswered.
//
//     const double residual = energies.balance() - at_start.balance();
#pragma once

#include <limits>

namespace sinew {

/// J. Work and dissipation are NaN where the body does not move in time, but from one equilibrium
/// to another.
struct Energies {
  double kinetic = 0;
  double pair = 0;           ///< between particles; negative for a body that coheres
  double bone = 0;           ///< in the bones' springs
  double gravity = 0;        ///< -m g.x
  double work_of_bones = 0;  ///< work since the start
  double dissipation = 0;    ///< lost to damping, drag and friction since the start
  double contact = 0;        ///< in the springs of obstacles
  double work_of_world = 0;  ///< work since the start: moving obstacles, pins, fields, muscles

  double stored() const { return kinetic + pair + bone + gravity + contact; }
  double work() const { return work_of_bones + work_of_world; }
  /// Constant during a motion, up to the errors of its steps.
  double balance() const { return stored() - work() + dissipation; }
};

/// Size of what is left of all forces on a body from outside, and of their moments about its
/// center of mass: nothing where it is in equilibrium. NaN: of a body that moves.
struct Unbalanced {
  double force = std::numeric_limits<double>::quiet_NaN();   ///< N
  double moment = std::numeric_limits<double>::quiet_NaN();  ///< N m
};

}  // namespace sinew

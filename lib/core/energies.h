// SPDX-License-Identifier: GPL-3.0-or-later
// The book a simulation keeps of a body's energy, J.
#pragma once

namespace sinew {

struct Energies {
  double kinetic = 0;
  double pair = 0;           ///< between particles; negative for a body that holds together
  double bone = 0;           ///< in the bones' springs
  double gravity = 0;        ///< -m g.x
  double work_of_bones = 0;  ///< put in since the start
  double dissipation = 0;    ///< lost to damping, drag and friction since the start
  double contact = 0;        ///< in the springs of obstacles
  double work_of_world = 0;  ///< put in since the start: moving obstacles, pins, fields, muscles

  double stored() const { return kinetic + pair + bone + gravity + contact; }
  double work() const { return work_of_bones + work_of_world; }
};

}  // namespace sinew

// SPDX-License-Identifier: GPL-3.0-or-later
// All of a simulation that steps change, to the last bit: what a simulation of the same body needs
// to go on as if it had never stopped. Partners, co-moving frames and bounds of what has moved are
// found anew: no bit of positions or velocities depends on them.
#pragma once

#include <array>
#include <cstdint>
#include <variant>
#include <vector>

#include <sinew/core/vector.h>

namespace sinew {

// The ledger a simulation keeps of a body's energy, J.

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

/// Work put in and losses so far, J.
struct LedgerEntries {
  double work = 0, dissipation = 0;
  double power = 0;    ///< put in at the beginning of the last step, W
  bool begun = false;  ///< whether there was one
};

/// Positions and velocities as a stepper has them.
template <class Coord, class Real>
struct MovingColumns {
  std::array<std::vector<Coord>, 3> x;
  std::array<std::vector<Real>, 3> v;
};
using MovingInDouble = MovingColumns<double, double>;       ///< m, m/s
using MovingInSingle = MovingColumns<std::int32_t, float>;  ///< lengths and lengths per step

/// What the numbers of single precision count, and until when they hold.
struct WholeNumbers {
  double length = 1;           ///< m
  Vec3 origin = Vec3::Zero();  ///< m
  Box box;                     ///< around all particles when that was looked at, m
  double traveled = 0;         ///< at most, since then, m
};

struct SimulationState {
  std::int64_t steps = 0;
  LedgerEntries ledger;
  LedgerEntries world_ledger;  ///< of obstacles, fields, muscles and pins
  double held_at_start = 0;    ///< kinetic energy of what pins hold, J
  bool kicked = false;         ///< velocities are half a step ahead (velocity Verlet)
  std::variant<MovingInDouble, MovingInSingle> moving;
  std::vector<std::uint32_t> order;  ///< whose they are, as places in the caller's order
  WholeNumbers whole_numbers;        ///< of single precision
  double mean_when_sorted = 0;       ///< length of lists, for which a sort is tried anew
  std::vector<double> rest_length;   ///< of bonds, m; 0 once broken
  std::vector<std::int32_t> broken;  ///< bonds, by particle in the caller's order
};

}  // namespace sinew

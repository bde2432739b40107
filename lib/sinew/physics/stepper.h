// SPDX-License-Identifier: GPL-3.0-or-later
// What every stepper offers to Simulation: see lists/list_stepper.h and reference/cell_stepper.h.
//
//     const StepSums sums = stepper.step(pose);
//     ledger.add_step(sums.power, sums.lost);
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <sinew/core/cell_grid.h>
#include <sinew/core/error.h>
#include <sinew/core/options.h>
#include <sinew/core/particles.h>
#include <sinew/core/simulation_state.h>
#include <sinew/physics/forces.h>

namespace sinew {

// Work of the bones and losses since the start, step by step.

class EnergyLedger {
 public:
  explicit EnergyLedger(double step) : step_(step), last_(step) {}

  /// Of the steps that follow, s.
  void set_step(double step) { step_ = step; }

  /// Adds a step that began with this power of the bones and this loss (W); trapezoidal rule for
  /// the power.
  void add_step(double power, double lost) {
    now_.work = work_until(power);
    now_.power = power;
    now_.begun = true;
    now_.dissipation += step_ * lost;
    last_ = step_;
  }

  /// Until a moment with that power, J.
  double work_until(double power) const {
    return now_.begun ? now_.work + last_ * (now_.power + power) / 2 : now_.work;
  }
  /// Including half of the step that begins with that loss, for the moment of the positions, J.
  double dissipation_until(double lost) const { return now_.dissipation + step_ * lost / 2; }

  const LedgerEntries& entries() const { return now_; }
  /// `last`: the size of the step that was added last, s.
  void restore(const LedgerEntries& entries, double last) {
    now_ = entries;
    step_ = last_ = last;
  }

 private:
  double step_, last_;  ///< s, of the next step and of the one before
  LedgerEntries now_;
};

struct Stepping {
  Integrator integrator = Integrator::symplectic_euler;
  double step = 0;              ///< s
  Vec3 gravity = Vec3::Zero();  ///< m/s^2
  Precision precision = Precision::binary64;
  NeighborSearch neighbor_search = NeighborSearch::lists;
};

// A bond that snaps drives a particle by (b - a) sqrt(k lambda / 3m) dt, 0.1 r at half the limit;
// faster than several bonds at once is only an unstable run.
inline constexpr double most_radii_per_step = 0.25;

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

/// The present rest lengths of a body's bonds, by particle id.
class BondRest {
 public:
  /// Neighbors at rest by id, ascending: the nearest ones and the second ones (none: empty).
  BondRest(const NeighborLists& nearest, const NeighborLists& second);

  /// Of one direction of a bond that is whole, m. What is never set is broken.
  void set(std::int32_t i, std::int32_t j, bool nearest, double length);
  /// By entry of the nearest ones, then of the second ones, m; 0 once broken.
  std::vector<double> take() { return std::move(length_); }

 private:
  const NeighborLists& nearest_;
  const NeighborLists& second_;
  std::vector<double> length_;
};

/// The saved state is not one of this stepper, or not valid.
inline Error not_a_state(const std::string& why) {
  return bad_input("the saved state does not fit this body: " + why,
                   "begin again without --resume");
}

/// Throws bad input unless there are `particles` positions and velocities, all of them finite.
template <class Coord, class Real>
void check_moving(const MovingColumns<Coord, Real>& moving, std::size_t particles) {
  for (int axis = 0; axis < 3; ++axis) {
    if (moving.x[axis].size() != particles || moving.v[axis].size() != particles)
      throw not_a_state("it is of " + std::to_string(moving.x[axis].size()) + " particles, not " +
                        std::to_string(particles));
    for (std::size_t k = 0; k < particles; ++k)
      if (!std::isfinite(static_cast<double>(moving.x[axis][k])) ||
          !std::isfinite(moving.v[axis][k]))
        throw not_a_state("particle " + std::to_string(k) + " has a value that is not finite");
  }
}

/// Throws bad input unless there are so many branches of bonds, all finite.
void check_branches(const SimulationState& state, std::size_t branches);

/// How often neighbor lists were made, and how long they are.
struct ListCounts {
  std::int64_t rebuilds = 0, surveys = 0, sorts = 0;  ///< of all pieces
  std::int64_t listed = 0, pruned = 0;                ///< pieces, one by one
  double outer = 0, inner = 0;                        ///< differences per block
  /// Wall time, s.
  double rebuilding = 0, pruning = 0, checking = 0, sorting = 0;
};

}  // namespace sinew
